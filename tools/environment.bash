# Enter the environment of the workspace; sourced by ./rosbots, needs ROOT and WORKSPACE.

# Foreign workspaces that the caller has sourced stay visible behind ours.
enter_environment() {
  local devel=$WORKSPACE/devel foreign=${ROS_PACKAGE_PATH:-}
  # The generated setup file reads variables that may be unset, and its own _CATKIN_SETUP_DIR.
  set +u
  unset _CATKIN_SETUP_DIR
  # shellcheck disable=SC1091
  source "$devel/setup.bash" --extend
  set -u
  # what the caller had set by hand has been replaced just now
  if [[ -n $foreign && :$ROS_PACKAGE_PATH: != *:$foreign:* ]]; then
    export ROS_PACKAGE_PATH=$ROS_PACKAGE_PATH:$foreign
  fi
  # python3 must be the one with PyBullet, whatever else (pyenv, conda) is first in the caller's PATH.
  export PATH="$WORKSPACE/venv/bin:$PATH"
  export ROSBOTS_ROOT=$ROOT
  local ros_home=${ROS_HOME:-${HOME:-/nonexistent}/.ros}
  if ! mkdir -p "$ros_home" 2> /dev/null || [[ ! -w $ros_home ]]; then
    export ROS_HOME=$WORKSPACE/ros_home
    mkdir -p "$ROS_HOME"
  fi
}
