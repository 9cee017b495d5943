# Included by message packages of companions/ after generate_messages: generates all their code in
# one process while CMake configures, so that make finds it up to date. catkin alone starts two
# processes for each message, which took most of the time of a build.

get_filename_component(companions ${companion} DIRECTORY)
execute_process(
  COMMAND ${PYTHON_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/make_messages.py ${companions}
    ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION} ${CATKIN_DEVEL_PREFIX}/include
    ${PROJECT_NAME}
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the messages of ${PROJECT_NAME} cannot be generated")
endif()
