# Enter the environment of the workspace; sourced by ./rosbots, needs ROOT and WORKSPACE.

# The workspaces that the caller has sourced precede ours: their packages hide ours of the same name.
enter_environment() {
  local name
  local -A callers=()
  for name in CMAKE_PREFIX_PATH LD_LIBRARY_PATH PKG_CONFIG_PATH PYTHONPATH ROS_PACKAGE_PATH; do
    callers[$name]=${!name:-}
    unset "$name"
  done
  find_ros_home  # first: rospack, in a hook of the setup file, writes there
  if has_workspace; then
    source_workspace
    use_navigation
    put_unbuilt_before_ours "${callers[ROS_PACKAGE_PATH]}"
  else
    use_sources
  fi
  for name in "${!callers[@]}"; do
    export "$name=$(put_before "${callers[$name]}" "${!name:-}")"
  done
  export PYTHONUTF8=1  # so that names and files are read as UTF-8 whatever the locale says
  prefer_own_distutils
  export ROSBOTS_ROOT=$ROOT
  find_address
  find_runtime_folder
}

source_workspace() {
  local room
  room=$(find_room) || exit 1
  # The generated setup file reads variables that may be unset, and its own _CATKIN_SETUP_DIR.
  set +u
  unset _CATKIN_SETUP_DIR
  # shellcheck disable=SC1091
  TMPDIR=$room source "$WORKSPACE/devel/setup.bash"
  set -u
}

# The workspace of ./rosbots navigation, if it is built: what its set-up file would say, without a
# third of a second for its interpreter.
use_navigation() {
  local devel=$WORKSPACE/navigation/devel
  [[ -f $WORKSPACE/stamps/navigation ]] || return 0
  export CMAKE_PREFIX_PATH=$CMAKE_PREFIX_PATH:$devel
  export ROS_PACKAGE_PATH=${ROS_PACKAGE_PATH/:\/usr\/share/}:$WORKSPACE/navigation/src:/usr/share
  export LD_LIBRARY_PATH=${LD_LIBRARY_PATH:+$LD_LIBRARY_PATH:}$devel/lib
  export PYTHONPATH=$PYTHONPATH:$devel/lib/python3/dist-packages
}

# What the workspace's set-up file would say, were there one: packages and modules as they lie here.
use_sources() {
  export ROS_PACKAGE_PATH=$ROOT:$ROOT/companions:/usr/share
  export PYTHONPATH=$WORKSPACE/messages:$ROOT/src
  local folder
  for folder in "$ROOT"/companions/*/src; do PYTHONPATH+=:$folder; done
  export PATH=$WORKSPACE/venv/bin:$PATH
  export ROS_MASTER_URI=${ROS_MASTER_URI:-http://localhost:11311} ROS_ETC_DIR=/etc/ros
  export ROS_ROOT=/usr/share/ros ROS_DISTRO=Debian ROS_PYTHON_VERSION=3 ROS_VERSION=1
}

# A package of the caller that was never built precedes ours of that name for rospack, but not for
# catkin, by which roslaunch resolves $(find PACKAGE)/FILE. So it is linked into a workspace of its own
# before ours. Only those of our packages are hidden that hold nothing but files: an unbuilt package
# could not replace programs or messages.
put_unbuilt_before_ours() { # put_unbuilt_before_ours ROS_PACKAGE_PATH
  local folder name manifest overlay theirs=() place=()
  IFS=: read -ra place <<< "$1"
  for name in gazebo_plugins media_export; do
    for folder in "${place[@]}"; do
      [[ -d $folder && $folder != */share && $folder != "$WORKSPACE"/* ]] || continue
      manifest=$(find -L "$folder" -maxdepth 4 -path "*/$name/package.xml" -print -quit 2> /dev/null)
      [[ -n $manifest ]] || continue
      theirs+=("$(realpath -- "${manifest%/*}")")
      break
    done
  done
  [[ ${#theirs[@]} -gt 0 ]] || return 0
  overlay=$WORKSPACE/overlays/$(sha256sum <<< "${theirs[*]}" | cut -c1-12)
  mkdir -p "$overlay/src" && ln -sfn -t "$overlay/src" -- "${theirs[@]}" &&
    printf %s "$overlay/src" > "$overlay/.catkin" || return 0
  export CMAKE_PREFIX_PATH=$overlay:$CMAKE_PREFIX_PATH
}

# roslaunch imports distutils; replaced by setuptools, it would start 0.1 s later. From Python 3.12 on
# there is no other: asked for one, setuptools could not be imported at all.
prefer_own_distutils() {
  local interpreter
  interpreter=$(readlink -f /usr/bin/python3)
  if [[ -e /usr/lib/${interpreter##*/}/distutils/__init__.py ]]; then
    export SETUPTOOLS_USE_DISTUTILS=${SETUPTOOLS_USE_DISTUTILS:-stdlib}
  fi
}

# Qt complains on every start of RViz where there is none, as in containers.
find_runtime_folder() {
  local folder=${TMPDIR:-/tmp}/rosbots-runtime-$UID
  if [[ -z ${XDG_RUNTIME_DIR:-} ]] && mkdir -p -m 700 "$folder" 2> /dev/null && [[ -O $folder ]]; then
    export XDG_RUNTIME_DIR=$folder
  fi
}

# catkin's set-up file passes all it finds out through a file in TMPDIR, which may be full.
find_room() {
  local place
  for place in "${TMPDIR:-/tmp}" /dev/shm "$WORKSPACE"; do
    if takes_files "$place"; then
      echo "$place"
      return
    fi
  done
  echo "rosbots: nothing can be written in ${TMPDIR:-/tmp}, /dev/shm and $WORKSPACE;" \
    'make room in one of them, or set TMPDIR to a folder that has some' >&2
  return 1
}

takes_files() {
  local probe code=0
  probe=$(mktemp "$1/rosbots.XXXXXXXXXX" 2> /dev/null) || return 1
  head -c 65536 /dev/zero > "$probe" 2> /dev/null || code=1
  rm -f "$probe"
  return "$code"
}

# put_before THEIRS OURS: one search path of two, each folder once.
put_before() {
  local folder i path=$2
  local folders=()
  IFS=: read -ra folders <<< "$1"
  for ((i = ${#folders[@]} - 1; i >= 0; i--)); do
    folder=${folders[i]}
    if [[ -n $folder && :$2: != *:$folder:* ]]; then path=$folder${path:+:$path}; fi
  done
  echo "$path"
}

# Drop the workspaces of the caller: for commands that show or test the robot of this project.
leave_workspaces() { unset CMAKE_PREFIX_PATH PKG_CONFIG_PATH PYTHONPATH ROS_PACKAGE_PATH; }

# ROS writes its logs there; roslaunch fails if it cannot.
find_ros_home() {
  local temporary=${TMPDIR:-/tmp}/rosbots-$UID
  if [[ -z ${ROS_HOME-} ]]; then unset ROS_HOME; fi  # rospack would write into the current folder
  if takes_logs "${ROS_HOME:-${HOME:-/nonexistent}/.ros}"; then return; fi
  if takes_logs "$WORKSPACE/ros_home"; then
    export ROS_HOME=$WORKSPACE/ros_home
    return
  fi
  mkdir -m 700 "$temporary" 2> /dev/null || true
  if [[ -O $temporary ]] && takes_logs "$temporary"; then
    export ROS_HOME=$temporary
  else
    echo 'rosbots: no folder for logs can be written; set ROS_HOME to one that can' >&2
  fi
}

takes_logs() { mkdir -p "$1/log" 2> /dev/null && [[ -w $1/log ]]; }

# require_master_port ARGS…: of roslaunch, which would end with a traceback if a program that is no
# ROS master listens on the port of the master.
require_master_port() {
  local uri=${ROS_MASTER_URI:-http://localhost:11311} host port
  while [[ $# -gt 1 ]]; do
    if [[ $1 == -p || $1 == --port ]]; then uri=http://localhost:$2; fi
    shift
  done
  [[ $uri =~ ^http://(localhost|127\.[0-9.]+|$(uname -n)):([0-9]+) ]] || return 0
  host=${BASH_REMATCH[1]} port=${BASH_REMATCH[2]}
  { : <> "/dev/tcp/$host/$port"; } 2> /dev/null || return 0  # roslaunch starts a master there
  timeout 5 /usr/bin/python3 -c 'import sys, xmlrpc.client
xmlrpc.client.ServerProxy(sys.argv[1]).getPid("/rosbots")' "$uri" 2> /dev/null || {
    echo "rosbots: a program that is no ROS master has port $port; end it, or choose another port:" \
      "export ROS_MASTER_URI=http://localhost:$((port + 1))" >&2
    exit 1
  }
}

# Nodes announce the hostname to each other; if it cannot be resolved, they could not connect.
find_address() {
  if [[ -z ${ROS_HOSTNAME:-}${ROS_IP:-} ]] && ! timeout 2 getent hosts "$(uname -n)" > /dev/null; then
    export ROS_HOSTNAME=localhost
  fi
}
