"""PyPI's module xacro, made to fit the Python that runs."""

from .module import import_xacro

__all__ = ['import_xacro']
