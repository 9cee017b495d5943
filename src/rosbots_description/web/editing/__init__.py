"""Panels that edit the world: insert, move, change, delete, and undo."""

from .change_panel import ChangePanel, Inspection
from .editor import Editor, EditorPanel
from .gizmo import Drags, Gizmo
from .history import History
from .insert import InsertPanel, Library
from .inspector import Inspector

__all__ = [
    'ChangePanel',
    'Drags',
    'Editor',
    'EditorPanel',
    'Gizmo',
    'History',
    'InsertPanel',
    'Inspection',
    'Inspector',
    'Library',
]
