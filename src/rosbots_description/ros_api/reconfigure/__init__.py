"""Settings by dynamic_reconfigure.

Its library is slow to import, so each module is imported only where needed.
"""

__all__ = ['camera', 'diff_drive', 'gains', 'physics', 'wheel_slip']
