"""The tasks under Gymnasium's names, such as `rosbots/GoToGoal-v0`."""

from gymnasium.envs.registration import register, registry

# Class and module of each task, and the control steps after which an episode is truncated.
_TASKS = {
    'FollowLine': ('follow_line', 600),
    'GoToGoal': ('go_to_goal', 400),
    'Maze': ('maze', 3000),
    'Wander': ('wander', 600),
}


def register_envs() -> None:
    """Register the tasks; Gymnasium calls this when it is imported, and so does this package."""
    tasks = f'{__package__}.tasks'
    for name, (module, steps) in _TASKS.items():
        known = f'rosbots/{name}-v0'
        if known not in registry:
            register(
                known,
                f'{tasks}.{module}:{name}',
                max_episode_steps=steps,
                vector_entry_point=f'{tasks}.{module}:make_vec',
            )
