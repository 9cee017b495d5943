"""What people look at: markers and frames for RViz, and pictures by a camera."""

__all__ = ['camera', 'frames', 'markers', 'visuals']
