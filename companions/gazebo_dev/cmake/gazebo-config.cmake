# Found by find_package(gazebo) where there is no Gazebo; see the README of gazebo_dev.
set(gazebo_STAND_IN TRUE)
set(GAZEBO_FOUND TRUE)
# catkin_package(DEPENDS GAZEBO) warns if there are neither folders nor libraries
set(GAZEBO_INCLUDE_DIRS "${CMAKE_CURRENT_LIST_DIR}/include")
foreach(name LIBRARIES LIBRARY_DIRS CXX_FLAGS PLUGIN_PATH MODEL_PATH MEDIA_PATH)
  set(GAZEBO_${name} "")
endforeach()
message(STATUS "gazebo: only its name is here; what includes Gazebo's headers cannot be built, "
  "and the simulator's plugins need no building")
