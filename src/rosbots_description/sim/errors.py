"""What can go wrong in the simulator, each with a sentence that names place, fault and cure."""


class SimError(Exception):
    """Any fault the simulator reports to its user; `str()` is the sentence to show."""


class ModelError(SimError):
    """A model description that cannot be simulated as written."""


class NotFoundError(SimError):
    """A model, link, joint or frame of that name does not exist in the world."""


class PluginError(SimError):
    """A plugin that cannot do its work; the model lives on without it."""
