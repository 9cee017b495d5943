"""What people look at: markers and frames for RViz, and overview pictures."""

__all__ = ['frames', 'markers', 'overview_picture', 'visuals']
