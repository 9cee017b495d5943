"""A two-wheeled robot and a PyBullet-backed simulator with Gazebo Classic's ROS interface.

``sim`` is the simulator and knows nothing of ROS, ``ros_api`` connects it to ROS, ``cli`` holds the
front ends of the executables.
"""
