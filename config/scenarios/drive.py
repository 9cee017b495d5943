"""The policy of drive.yaml: drive to a point by odometry."""

import math

GOAL = 2.5, 0.0  # in the world [m]
REACHED = 0.05  # [m]


def go_to(run):
    """Return the policy of one run; `run` has `number`, `parameters` and `seed`."""
    goal_x, goal_y = GOAL

    def act(time, readings):
        """Return messages by topic, from the time [s] and the newest of each record."""
        odometry = readings['odom']
        if odometry is None or time < 0.5:
            return {}  # it still drops onto its wheels
        (x, y, _), (_, _, qz, qw) = odometry.pose
        yaw = 2.0 * math.atan2(qz, qw)
        distance = math.hypot(goal_x - x, goal_y - y)
        turn = math.remainder(math.atan2(goal_y - y, goal_x - x) - yaw, math.tau)
        if distance < REACHED:
            turn, distance = 0.0, 0.0
        return {
            '/part2_cmr/cmd_vel': {
                'linear': {'x': min(0.6, distance)},
                'angular': {'z': max(-1.0, min(1.0, 2.0 * turn))},
            }
        }

    return act
