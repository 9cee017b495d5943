"""How our programs behave as processes: they print lines at once and end at once."""

import sys

import rospy
from rospy.impl.registration import get_registration_listeners


def print_lines_at_once() -> None:
    """Write each line when it is complete, also into a pipe or file, where Python would wait."""
    sys.stdout.reconfigure(line_buffering=True)


def end_at_once() -> None:
    """Spare this process up to half a second at its end; call it after `init_node`.

    rospy's registration thread looks only every 0.5 s whether the node is shutting down, and the
    shutdown waits for it. Waking it needs rospy's internals: there is no public way.
    """
    # Now, since rospy clears the list before the hook runs.
    conditions = [
        listener.cond for listener in get_registration_listeners().listeners
        if hasattr(listener, 'cond')
    ]

    def wake(_reason: str) -> None:
        for condition in conditions:
            with condition:
                condition.notify_all()

    rospy.core.add_shutdown_hook(wake)
