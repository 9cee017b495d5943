"""A model compiled for a physics engine, once per description."""

import os
from dataclasses import dataclass, replace
from typing import Self

from ..description import ModelSpec
from ..meshes import SharedFile


@dataclass(frozen=True)
class CompiledModel:
    """A model ready for an engine. Its mesh files exist as long as this object.

    Each engine extends this class.
    """

    spec: ModelSpec
    files: tuple[SharedFile, ...]
    size: int  # bytes that the engine reads

    @property
    def has_files(self) -> bool:
        """Whether all mesh files still exist; the folder may have been cleared."""
        return all(map(os.path.isfile, self.files))

    def bare(self) -> Self:
        """Return only what the engine uses: no name, visuals, sensors and plugins."""
        return replace(self, spec=bare(self.spec))


def bare(spec: ModelSpec) -> ModelSpec:
    """Return the parts of a model that are relevant to physics."""
    links = tuple(replace(link, visuals=(), sensors=(), parts=()) for link in spec.links)
    return ModelSpec('', links, spec.joints, static=spec.static)
