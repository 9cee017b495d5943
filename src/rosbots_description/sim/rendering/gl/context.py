"""An OpenGL context without a display: on a graphics card, or else in software."""

from ctypes.util import find_library
from typing import Any

import moderngl

_DEVICES = 16  # as many are tried
_SOFTWARE = ('llvmpipe', 'softpipe', 'swrast')
_EGL: dict[str, Any] = {'backend': 'egl'}
LIBRARIES = {'libgl': ('GL', 'libgl1'), 'libegl': ('EGL', 'libegl1')}


class NoContextError(Exception):
    """Nothing draws here; the sentence says what would help."""


def open_context() -> tuple[moderngl.Context, str, bool]:
    """Return a context, the name of what draws, and whether that is software.

    Raises:
        NoContextError: there is none.
    """
    for name, package in LIBRARIES.values():
        if find_library(name) is None:
            raise NoContextError(
                f'lib{name} is missing; install {package}, libegl-mesa0 and libgl1-mesa-dri')
    software, reason = None, ''
    for number in range(_DEVICES):
        try:
            context = moderngl.create_context(
                require=330, standalone=True, **_EGL | {'device_index': number})
        except Exception as error:  # whatever a driver raises: the next one may do
            reason = str(error)
            if 'out of range' in reason or 'requested device index' in reason:
                break
            continue
        name = context.info['GL_RENDERER']
        if not any(word in name for word in _SOFTWARE):
            return context, name, False
        software = context, name, True
        break  # software comes last
    if software is None:
        raise NoContextError(f'there is no OpenGL 3.3 ({reason}); install libegl-mesa0 and '
                             'libgl1-mesa-dri, which draw in software')
    return software
