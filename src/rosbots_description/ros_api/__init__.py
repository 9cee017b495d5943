"""The simulator on the ROS graph: the only place that knows rospy and message types."""
