"""An OpenGL context without a display: on a graphics card, or else in software."""

from ctypes.util import find_library
from typing import Any

import moderngl

_DEVICES = 16  # number of EGL devices to try
_SOFTWARE = ('llvmpipe', 'softpipe', 'swrast')
_EGL: dict[str, Any] = {'backend': 'egl'}
LIBRARIES = {'libgl': ('GL', 'libgl1'), 'libegl': ('EGL', 'libegl1')}


class NoContextError(Exception):
    """There is no OpenGL; the message says what to install."""


def open_context() -> tuple[moderngl.Context, str, bool]:
    """Return a context, the name of the renderer, and whether it is a software renderer.

    Raises:
        NoContextError: there is none.
    """
    for name, package in LIBRARIES.values():
        if find_library(name) is None:
            raise NoContextError(
                f'lib{name} is missing; install {package}, libegl-mesa0 and libgl1-mesa-dri'
            )
    software, reason = None, ''
    for number in range(_DEVICES):
        try:
            context = moderngl.create_context(
                require=330, standalone=True, **_EGL | {'device_index': number}
            )
        except Exception as error:  # any error of a driver: the next device may work
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
        raise NoContextError(
            f'there is no OpenGL 3.3 ({reason}); install libegl-mesa0 and '
            'libgl1-mesa-dri, which draw in software'
        )
    return software
