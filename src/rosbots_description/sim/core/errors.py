"""What can go wrong in the simulator, each with a sentence that names place, fault and cure."""

_HEAD, _TAIL = 1200, 600  # characters of a long sentence that are shown; the cure stands at the end


class SimError(Exception):
    """Any fault the simulator reports to its user; `str()` is the sentence to show.

    It is one printable line of bearable length, whatever a user's text brought into it.
    """

    def __str__(self) -> str:
        """Return the sentence."""
        return one_line(super().__str__())


class ModelError(SimError):
    """A model description that cannot be simulated as written."""


class AbsentError(ModelError):
    """A file that a description names is not where it says; a shape can be left out for it."""


class ShapeError(ModelError):
    """A shape that cannot be made; as in Gazebo the model stands without it.

    `uri` is what names the mesh that is no good, '' where it is no mesh.
    """

    def __init__(self, sentence: str, uri: str = '') -> None:
        super().__init__(sentence)
        self.uri = uri


class NotFoundError(SimError):
    """A model, link, joint or frame of that name does not exist in the world."""


class PluginError(SimError):
    """A plugin that cannot do its work; the model lives on without it."""


def one_line(text: str) -> str:
    """Return a text with its unprintable characters escaped, and without a long one's middle."""
    if len(text) > _HEAD + _TAIL:
        text = f'{text[:_HEAD]} … {text[-_TAIL:]}'
    if text.isprintable():
        return text
    return ''.join(
        character if character.isprintable() else character.encode('unicode_escape').decode()
        for character in text
    )
