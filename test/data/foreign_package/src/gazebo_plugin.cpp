#include <gazebo/common/Plugin.hh>
