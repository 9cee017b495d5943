"""Settings by dynamic_reconfigure. Its library takes long to load.

Each module is imported where it is needed.
"""

__all__ = ['camera', 'physics', 'wheel_slip']
