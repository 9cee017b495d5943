"""Debian's joint_state_publisher_gui, with sliders that round their values.

Debian's version passes floats to its sliders, which QSlider rejects under Python 3.10 and later, so
that the program ends at once.

Publishes:
    joint_states (sensor_msgs/JointState) and parameters: as joint_state_publisher has them.
"""

import signal
import sys
import threading

import joint_state_publisher_gui as window
import rospy
from joint_state_publisher import JointStatePublisher, get_param
from PyQt5.QtWidgets import QApplication, QSlider

NAME = 'joint_state_publisher_gui'


class RoundingSlider(QSlider):
    """A slider that accepts floats."""

    def setValue(self, value: float) -> None:  # noqa: N802  Qt's name
        """Set the nearest integer."""
        super().setValue(round(value))


def main() -> int:
    """Show the window until it is closed; return an exit code."""
    rospy.init_node(NAME)
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Python's handlers do not run in Qt's event loop
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    app = QApplication(sys.argv)
    window.QSlider = RoundingSlider
    try:
        joints = JointStatePublisher()
    except RuntimeError as error:  # there is no robot_description
        sys.stderr.write(f'{NAME}: {error}\n')
        return 1
    title, rows = f'Node: {rospy.get_name()}', get_param('num_rows', 0)
    shown = window.JointStatePublisherGui(title, joints, rows)
    shown.show()
    threading.Thread(target=joints.loop, daemon=True).start()
    return app.exec_()
