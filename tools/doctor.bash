# ./rosbots doctor: what is installed on this machine, what is missing, and which command cures it.
# Sourced by ./rosbots after tools/setup.bash. Installs and changes nothing; needs no Python.

# doctor [--report]: print one screen; return 1 if something keeps the base set from running.
doctor() {
  local text status=0
  if [[ $# -gt 1 || ${1:---report} != --report ]]; then
    echo "rosbots: doctor takes --report or nothing" >&2
    return 2
  fi
  find_workspace
  choose_sets base
  text=$(diagnosis) || status=$?
  if [[ $# -eq 1 ]]; then
    echo '```text'
    anonymous "$text"
    echo '```'
  else
    echo "$text"
  fi
  return "$status"
}

diagnosis() {
  local set status=0
  row platform "$(system_name) ($ARCHITECTURE), $(nproc) processors, $(free_space)"
  row clone "$(git -C "$ROOT" describe --always --dirty 2> /dev/null || echo 'not a git clone')"
  row versions "$(versions)"
  for set in "${SETS[@]}"; do
    row "set $set" "$(state "$set")"
    if [[ $set == base && $(state base) != ready ]]; then status=1; fi
  done
  row workspace "$(if workspace_done; then echo ready; else echo 'not built; ./rosbots setup'; fi)"
  row OpenGL "$(opengl)"
  row display "${DISPLAY:-${WAYLAND_DISPLAY:-none; use gui:=false, or web:=true}}"
  row ports "11311 (roscore) $(port_state 11311), 8080 (gzweb) $(port_state 8080)"
  surroundings
  return "$status"
}

row() { printf '%-14s %s\n' "$1" "$2"; }

free_space() {
  df -Ph "$ROOT" | awk 'NR == 2 {print $4 "B of disk free"}'
}

# state SET: ready, or what is missing and its cure.
state() {
  local packages modules
  with_included "$1"
  if packages_done && python_done; then
    if navigation_done; then echo ready; else echo 'not built; ./rosbots navigation'; fi
    return
  fi
  mapfile -t packages < <(debian_packages "${CHOSEN[@]}" | missing_packages)
  mapfile -t modules < <(missing_modules)
  if [[ ${#packages[@]} -eq 0 && ${#modules[@]} -eq 0 ]]; then
    echo ready
  else
    echo "missing: ${#packages[@]} Debian packages$(examples "${packages[@]}")," \
      "${#modules[@]} Python packages$(examples "${modules[@]}"); ./rosbots setup $1"
  fi
}

# The names, if they are few.
examples() {
  if [[ $# -gt 0 && $# -le 3 ]]; then echo " ($*)"; fi
}

missing_modules() {
  local python=$WORKSPACE/venv/bin/python
  if [[ -x $python ]]; then
    python_requirements "${CHOSEN[@]}" | "$python" "$ROOT/tools/doctor.py" missing
  else
    python_requirements "${CHOSEN[@]}"
  fi
}

versions() {
  local python=$WORKSPACE/venv/bin/python package found=()
  for package in python3-rospy rviz; do
    found+=("$package $(dpkg-query -W -f '${Version}' "$package" 2> /dev/null || echo missing)")
  done
  if [[ -x $python ]]; then
    found+=("$("$python" "$ROOT/tools/doctor.py" versions)")
  else
    found+=('no Python environment')
  fi
  printf '%s, ' "${found[@]}" | sed 's/, $//'
}

opengl() {
  if [[ -x $WORKSPACE/venv/bin/python ]]; then
    PYTHONPATH=$ROOT/src timeout 30 "$WORKSPACE/venv/bin/python" "$ROOT/tools/doctor.py" opengl ||
      echo 'does not answer'
  else
    echo 'unknown until ./rosbots setup'
  fi
}

port_state() {
  if (: < "/dev/tcp/127.0.0.1/$1") 2> /dev/null; then echo 'in use'; else echo free; fi
}

# Settings of the terminal that change what commands do.
surroundings() {
  local name found=()
  for name in ROS_MASTER_URI ROS_IP ROS_HOSTNAME ROS_PACKAGE_PATH CONDA_PREFIX VIRTUAL_ENV \
    PYTHONPATH; do
    if [[ -n ${!name:-} ]]; then found+=("$name=${!name}"); fi
  done
  if [[ $(type -P python3 || echo /usr/bin/python3) != /usr/bin/python3 ]]; then
    found+=("python3 is $(type -P python3)")
  fi
  row terminal "${found[*]:-no settings of ROS, conda or Python}"
}

# A text without the names of the user, the machine and their folders.
anonymous() {
  local text=$1 name home=${HOME:-}
  text=${text//"$ROOT"/CLONE}
  if [[ ${#home} -gt 1 ]]; then text=${text//"$home"/\~}; fi
  for name in "$(id -un 2> /dev/null)" "$(uname -n)"; do
    # root and localhost name nobody
    if [[ $name =~ ^[A-Za-z0-9_.-]+$ && $name != root && $name != localhost ]]; then
      text=$(sed -E "s/(^|[^A-Za-z0-9_])${name//./\\.}($|[^A-Za-z0-9_])/\1NAME\2/g" <<< "$text")
    fi
  done
  sed -E 's#/home/[^/: ]+#/home/NAME#g' <<< "$text"
}
