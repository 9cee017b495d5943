"""Visualisation: markers and frames for RViz, and overview pictures."""

__all__ = ['frames', 'markers', 'overview_picture', 'visuals']
