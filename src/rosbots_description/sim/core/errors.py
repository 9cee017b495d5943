"""The simulator's exceptions. Each message names the location, the fault and the cure."""

from .faults import FaultPlace

_HEAD, _TAIL = 1200, 600  # characters shown of a long message; its cure comes last


class SimError(Exception):
    """Any fault the simulator reports to its user; `str()` is the message to show.

    The message is one printable line of limited length, whatever user input it quotes. `place`
    says where it is, as far as that is known.
    """

    place = FaultPlace()

    def __str__(self) -> str:
        """Return the message."""
        return one_line(super().__str__())


class ModelError(SimError):
    """A model description that cannot be simulated as written."""


class AbsentError(ModelError):
    """A file that a description names does not exist; the shape that needs it can be left out."""


class ShapeError(ModelError):
    """A shape that cannot be created; as in Gazebo the model is spawned without it.

    `uri` is the address of the unusable mesh, '' if the shape is not a mesh.
    """

    def __init__(self, sentence: str, uri: str = '') -> None:
        super().__init__(sentence)
        self.uri = uri


class NotFoundError(SimError):
    """A model, link, joint or frame of that name does not exist in the world."""


class PluginError(SimError):
    """A plugin that cannot be loaded; the model is spawned without it."""


def one_line(text: str) -> str:
    """Return a text with unprintable characters escaped, and its middle cut out if it is long."""
    if len(text) > _HEAD + _TAIL:
        text = f'{text[:_HEAD]} … {text[-_TAIL:]}'
    return printable(text)


def printable(text: str, kept: str = '') -> str:
    """Return a text with unprintable characters escaped, except those of `kept`."""
    if text.isprintable():
        return text
    return ''.join(
        character
        if character.isprintable() or character in kept
        else character.encode('unicode_escape').decode()
        for character in text
    )
