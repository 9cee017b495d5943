"""A model as a physics engine takes it, made once from its description."""

import os
from dataclasses import dataclass, replace
from typing import Self

from ..description import ModelSpec
from ..meshes import HeldFile


@dataclass(frozen=True)
class CompiledModel:
    """A model ready for an engine. Its mesh files are there for as long as it is.

    Each engine adds what it needs to this.
    """

    spec: ModelSpec
    files: tuple[HeldFile, ...]
    size: int  # bytes that the engine reads

    @property
    def has_files(self) -> bool:
        """Whether all mesh files are still there; somebody may have cleared the folder."""
        return all(map(os.path.isfile, self.files))

    def bare(self) -> Self:
        """Return what the engine sees of it: no name, looks, sensors and plugins."""
        return replace(self, spec=bare(self.spec))


def bare(spec: ModelSpec) -> ModelSpec:
    """Return what of a model moves and touches."""
    links = tuple(replace(link, visuals=(), sensors=(), parts=()) for link in spec.links)
    return ModelSpec('', links, spec.joints, static=spec.static)
