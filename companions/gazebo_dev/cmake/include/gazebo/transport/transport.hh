#include "gazebo/gazebo.hh"
