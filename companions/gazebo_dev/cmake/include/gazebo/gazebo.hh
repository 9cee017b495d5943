#error "There is no Gazebo here, so its plugins cannot be compiled. The simulator has Gazebo's and ROS's own built in, see doc/gazebo_compatibility.md of rosbots_description; leave this target out."
