"""Messages from browsers: what a page may send, and the numbers in it.

Viser takes what comes: any property of a control, any number, any size. A browser that sends what
no page sends is disconnected; a number that cannot be used is refused in a sentence.
"""

import io
import math
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias, Union

import msgspec
from PIL import Image, UnidentifiedImageError
from viser import _messages
from viser._gui_handles import _GuiInputHandle
from viser.infra._messages import get_type_hints_cached, wire_field_names

MAX_BYTES = 1_000_000  # of a message without a picture; parts of files have 2**19
MAX_TEXT = 1000  # characters of a text
MAX_NUMBER = 1e9  # of the scene [m], a number of a camera or a ray
MAX_PICTURE = 8192  # [pixels] of a side
KINDS = (
    'ViewerCameraMessage',
    'GuiUpdateMessage',
    'GuiButtonHoldMessage',
    'CommandTriggerMessage',
    'SceneNodeClickMessage',
    'SceneNodeDragMessage',
    'ScenePointerMessage',
    'TransformControlsUpdateMessage',
    'TransformControlsDragStartMessage',
    'TransformControlsDragEndMessage',
    'GetRenderResponseMessage',
    'FileTransferStartUpload',
    'FileTransferPart',
    'FileTransferPartAck',
)


Message: TypeAlias = Any  # one of `_STRUCTS`, which are made of viser's messages


class MalformedError(Exception):
    """A message that no page sends; what is wrong with it is one sentence."""


class RefusedError(Exception):
    """A command is not carried out; the message is one sentence for the person at the page."""


def _struct(kind: str) -> type[msgspec.Struct]:
    message = getattr(_messages, kind)
    hints = get_type_hints_cached(message)
    return msgspec.defstruct(
        kind,
        [(name, hints[name]) for name in wire_field_names(message)],
        tag_field='type',
        tag=kind,
        forbid_unknown_fields=True,
    )


_STRUCTS = {kind: _struct(kind) for kind in KINDS}
_DECODER: msgspec.msgpack.Decoder[Any] = msgspec.msgpack.Decoder(Union[tuple(_STRUCTS.values())])  # noqa: UP007  of as many as there are


def is_camera(raw: object) -> bool:
    """Tell whether a message says where a page looks from."""
    try:
        return type(read(raw)).__name__ == 'ViewerCameraMessage'
    except (MalformedError, RefusedError):
        return False


def read(raw: object) -> Message:
    """Return a message whose fields have the types and sizes that a page sends.

    Raises:
        MalformedError: it has not.
        RefusedError: a number or picture in it cannot be used.
    """
    if not isinstance(raw, bytes):
        raise MalformedError('A message is binary.')
    try:
        message = _DECODER.decode(raw)
    except (msgspec.DecodeError, RecursionError) as error:
        raise MalformedError(f'This is no message of the page: {error}.') from None
    kind = type(message).__name__
    if kind == 'GetRenderResponseMessage':
        _check_picture(message.payload)
    elif len(raw) > MAX_BYTES:
        raise MalformedError(f'A message has at most {MAX_BYTES} bytes.')
    for name in message.__struct_fields__:
        value = getattr(message, name)
        if isinstance(value, str) and len(value) > MAX_TEXT:
            raise MalformedError(f'{name} has at most {MAX_TEXT} characters.')
    if kind == 'GuiUpdateMessage' and list(message.updates) != ['value']:
        raise MalformedError('A page changes nothing but values.')
    if kind == 'ViewerCameraMessage':
        _check_camera(message)
    elif kind != 'GuiUpdateMessage':
        _check_numbers(
            _numbers(getattr(message, name) for name in message.__struct_fields__),
            f'{kind} of this browser',
        )
    return message


def check_value(control: _GuiInputHandle[Any], value: object) -> None:
    """Check a new value of a control.

    Raises:
        MalformedError: it has another type.
        RefusedError: it is not one that the control can have.
    """
    now, props = control.value, control._impl.props  # viser's
    label = getattr(props, 'label', 'a field')
    if not _is_like(value, now):
        raise MalformedError(f"This is no value of '{label}'.")
    if isinstance(value, str):
        options = getattr(props, 'options', None)
        if len(value) > MAX_TEXT:
            raise RefusedError(f"'{label}' takes at most {MAX_TEXT} characters")
        if options is not None and value not in options:
            raise RefusedError(f"'{label}' has no such choice any more")
    else:
        _check_range(value, props, label)


def _is_like(value: object, now: object) -> bool:
    """Return whether a value has the type of the present one; viser casts numbers."""
    if isinstance(now, tuple):
        return isinstance(value, list) and len(value) == len(now) and all(map(_is_number, value))
    if _is_number(now):
        return _is_number(value)
    return isinstance(now, bool | str) and isinstance(value, type(now))


def _check_range(value: object, props: object, label: str) -> None:
    numbers = [float(number) for number in _numbers([value])]
    if not all(map(math.isfinite, numbers)):
        raise RefusedError(f"'{label}' takes finite numbers")
    low, high = getattr(props, 'min', None), getattr(props, 'max', None)
    if low is not None and min(numbers) < low:
        raise RefusedError(f"'{label}' is at least {low:g}")
    if high is not None and max(numbers) > high:
        raise RefusedError(f"'{label}' is at most {high:g}")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _numbers(values: Iterable[object]) -> Iterable[float]:
    for value in values:
        if isinstance(value, list | tuple):
            yield from _numbers(value)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield value


def _check_numbers(numbers: Iterable[float], what: str) -> None:
    if not all(abs(number) <= MAX_NUMBER for number in numbers):  # neither for NaN
        raise RefusedError(
            f'{what} has a number that is not finite, or greater than {MAX_NUMBER:g}; it is ignored'
        )


def _check_camera(camera: Message) -> None:
    what = 'The camera of this browser'
    _check_numbers(_numbers(getattr(camera, name) for name in camera.__struct_fields__), what)
    directions: Sequence[Sequence[float]] = (
        camera.wxyz,
        camera.up_direction,
        [a - b for a, b in zip(camera.look_at, camera.position, strict=True)],
    )
    if any(math.hypot(*one) < 1e-9 for one in directions):
        raise RefusedError(f'{what} looks in no direction; it is ignored')
    if not (0.0 < camera.fov < math.pi and 0.0 < camera.near < camera.far):
        raise RefusedError(f'{what} has no field of view; it is ignored')
    if not all(0 < side <= MAX_PICTURE for side in (camera.image_height, camera.image_width)):
        raise RefusedError(f'{what} has more than {MAX_PICTURE} pixels; it is ignored')


def _check_picture(content: bytes) -> None:
    """Refuse a picture by its header, before it is unpacked."""
    try:
        with Image.open(io.BytesIO(content), formats=('JPEG', 'PNG')) as picture:
            size = picture.size
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        raise MalformedError('This is no picture.') from None
    if max(size) > MAX_PICTURE:
        raise MalformedError(f'A picture has at most {MAX_PICTURE} pixels at a side.')
