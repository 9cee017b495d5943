# Included by message packages of companions/ before generate_messages: generates all their code in
# one process while CMake configures, so that make finds it up to date. catkin alone starts two
# processes for each message, which took most of the time of a build.

get_filename_component(companions ${companion} DIRECTORY)
set(headers)
if(gencpp IN_LIST CATKIN_MESSAGE_GENERATORS)  # not in ROS_LANG_DISABLE
  set(headers ${CATKIN_DEVEL_PREFIX}/include)
endif()
execute_process(
  COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/make_messages.py ${companions}
    ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION} ${PROJECT_NAME} ${headers}
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the messages of ${PROJECT_NAME} cannot be generated")
endif()

# When a definition changes, make starts CMake again. So catkin's check need not do anything: in
# every make it would start a program for each message that tells the user to start CMake again.
file(GLOB definitions ${companion}/*/*.msg ${companion}/*/*.srv ${companion}/*/*.action)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${definitions})
set(GENMSG_CHECK_DEPS_SCRIPT -IS -c pass)
