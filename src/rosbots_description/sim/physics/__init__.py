"""What every physics engine takes and gives; the engines have a folder each."""

from .compiled_model import CompiledModel

__all__ = ['CompiledModel']
