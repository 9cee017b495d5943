"""Visualisation: markers and frames for RViz, the scene for browsers, and overview pictures."""

__all__ = ['contacts', 'frames', 'markers', 'overview_picture', 'scene', 'visuals']
