"""The node /gazebo: from its start to its end."""

__all__ = ['description_file', 'node']
