"""Programs that talk to the simulator, one module each; none loads what only another needs."""

__all__ = [
    'demo', 'gazebo_interface', 'joint_follower', 'joint_sliders', 'planar_sample', 'server_watch',
    'spawn_model', 'velocity_publisher',
]
