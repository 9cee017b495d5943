"""The programs of the package controller_manager, one module each, imported only where needed."""

__all__ = ['calls', 'groups', 'program', 'spawner', 'unspawner']
