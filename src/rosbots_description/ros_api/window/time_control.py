"""Time and speed of the simulator, by its services."""

import threading

from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from rosbots_msgs.srv import Step
from std_srvs.srv import Empty

from .calls import call

STEP_TIMEOUT = 600.0  # for many steps [s, wall]


class RosTimeControl:
    """Commands to the simulator's clock; each raises SimError if it is refused."""

    def __init__(self) -> None:
        self._turn = threading.Lock()  # the simulator refuses steps while it makes others

    def pause(self) -> None:
        """Pause simulated time."""
        call('pause_physics', Empty)

    def unpause(self) -> None:
        """Continue simulated time."""
        call('unpause_physics', Empty)

    def step(self, steps: int) -> None:
        """Pause and make so many steps."""
        with self._turn:
            self.pause()
            call('step', Step, STEP_TIMEOUT, steps=steps)

    def reset_world(self) -> None:
        """Return every model to its spawn pose; time is kept."""
        call('reset_world', Empty)

    def reset_simulation(self) -> None:
        """Restart at time zero."""
        call('reset_simulation', Empty)

    def set_speed(self, factor: float) -> None:
        """Set the target real-time factor; 0: as fast as possible."""
        now = call('get_physics_properties', GetPhysicsProperties)
        call(
            'set_physics_properties',
            SetPhysicsProperties,
            time_step=now.time_step,
            max_update_rate=factor / now.time_step,
            gravity=now.gravity,
            ode_config=now.ode_config,
        )
