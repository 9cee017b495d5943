"""Settings by dynamic_reconfigure, whose library is slow to import.

So each module is imported only where it is needed.
"""

__all__ = ['camera', 'physics', 'wheel_slip']
