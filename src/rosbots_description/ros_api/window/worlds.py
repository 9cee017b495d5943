"""World files, by a service of the simulator."""

from rosbots_msgs.srv import SaveWorld

from .calls import call


class RosWorlds:
    """The world as a file."""

    def save(self) -> tuple[str, str]:
        """Return the world as it stands as a world file, and a sentence about it."""
        answer = call('save_world', SaveWorld)
        return answer.sdf, answer.status_message
