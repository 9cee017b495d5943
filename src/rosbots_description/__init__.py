"""A two-wheeled robot and a PyBullet-backed simulator with Gazebo Classic's ROS interface.

``sim`` is the simulator and knows nothing of ROS, ``ros_api`` connects it to ROS, ``cli`` holds the
front ends of the executables. ``worlds`` and ``config`` are what they read.

It never looks itself up as a package and imports itself by relative names only: the companions
know it as ``rosbots_simulator``, as the name of this folder may be taken by a user's own package.
"""
