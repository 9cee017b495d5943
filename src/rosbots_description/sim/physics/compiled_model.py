"""A model as a physics engine takes it, made once from its description."""

import os
from dataclasses import dataclass

from ..description import ModelSpec
from ..meshes import HeldFile


@dataclass(frozen=True)
class CompiledModel:
    """A model ready for an engine. Its mesh files are there for as long as it is.

    Each engine adds what it needs to this.
    """

    spec: ModelSpec
    files: tuple[HeldFile, ...]

    @property
    def has_files(self) -> bool:
        """Whether all mesh files are still there; somebody may have cleared the folder."""
        return all(map(os.path.isfile, self.files))
