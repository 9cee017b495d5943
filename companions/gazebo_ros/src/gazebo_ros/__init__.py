"""Gazebo's Python module for ROS clients, under its usual name."""
