"""The simulator: plain values and physics, without ROS."""
