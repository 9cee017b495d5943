"""Client programs of the simulator, one module each, imported only where needed."""

__all__ = [
    'demo',
    'gazebo_interface',
    'gz',
    'joint_follower',
    'joint_sliders',
    'node_program',
    'planar_sample',
    'save_map',
    'save_world',
    'scenario_run',
    'server_watch',
    'spawn_model',
    'velocity_publisher',
]
