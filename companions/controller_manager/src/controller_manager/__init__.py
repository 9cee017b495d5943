"""The Python module of controller managers for ROS clients, under its usual name."""
