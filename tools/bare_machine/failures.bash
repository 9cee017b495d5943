# What goes wrong on a newcomer's machine; sourced by tools/bare_machine_test.sh.
#
# Each case ends in one sentence and a non-zero exit, with nothing half done, or simply works. Those
# of BEFORE run on a machine without any of our packages, as a newcomer who may use sudo; the last of
# them sets everything up. Those of AFTER need that.

BEFORE=(derivative no_sudo sudo_refused no_network apt_locked no_disk_for_apt interrupted)
AFTER=(no_disk network_gone venv_conda_pyenv spaces_and_umlauts read_only_home no_home second_clone
  port_taken moved_clone)
FAILED=0

run_failures() {
  local name
  [[ $# -gt 0 ]] || set -- "${BEFORE[@]}" "${AFTER[@]}"
  if [[ ! -d $bare$CLONE ]]; then clone_into "$CLONE"; fi
  for name in "$@"; do
    echo 'newcomer ALL=(ALL) NOPASSWD: ALL' > "$bare/etc/sudoers.d/newcomer"
    AROUND=()
    SECONDS=0
    "case_$name"
    undo
  done
  return "$FAILED"
}

# What a case has mounted or started.
undo() {
  if [[ -n ${HOLDER:-} ]]; then
    kill "$HOLDER"
    wait "$HOLDER" || true
  fi
  HOLDER=
  local mounted
  for mounted in "${MOUNTED[@]}"; do umount -l "$mounted"; done
  MOUNTED=()
}
MOUNTED=()

# mount_full FOLDER: a disk there that has no room for more than a megabyte.
mount_full() {
  mkdir -p "$bare$1"
  mount -t tmpfs -o size=1m full "$bare$1"
  chroot "$bare" chown newcomer: "$1"
  MOUNTED+=("$bare$1")
}

verdict() {
  printf '%-6s %-20s %3d s  %s\n' "$1" "${FUNCNAME[2]#case_}" "$SECONDS" "$2"
  if [[ $1 == FAILED ]]; then
    FAILED=1
    sed 's/^/    /' "$bare.output"
  fi
}

# refuses PATTERN COMMAND…: that ends, with an error, in one sentence of ours that matches.
refuses() {
  local pattern=$1 code=0 said
  shift
  inside newcomer "$@" > "$bare.output" 2>&1 < /dev/null || code=$?
  said=$(grep '^rosbots: ' "$bare.output" || true)
  if [[ $code -ne 0 && $(wc -l <<< "$said") -eq 1 && $said =~ $pattern &&
    $(tail -n 1 "$bare.output") == "$said" && -z $(chroot "$bare" dpkg --audit) ]] &&
    ! grep -q Traceback "$bare.output"; then
    verdict ok "$said"
  else
    verdict FAILED "exit code $code; expected an error and one sentence: $pattern"
  fi
}

# works COMMAND…: that ends well.
works() {
  local code=0
  inside newcomer "$@" > "$bare.output" 2>&1 < /dev/null || code=$?
  if [[ $code -eq 0 ]]; then verdict ok works; else verdict FAILED "exit code $code"; fi
}

IMPORT=(exec python3 -c 'import rospy, pybullet')

# ---- before anything is installed -----------------------------------------------------------

case_derivative() {
  printf 'ID=ubuntu\nID_LIKE=debian\nVERSION_ID="24.04"\nPRETTY_NAME="Ubuntu 24.04 LTS"\n' \
    > "$bare.release"
  mount --bind "$bare.release" "$bare/usr/lib/os-release"
  MOUNTED+=("$bare/usr/lib/os-release")
  refuses 'Debian 12 (or|and) 13.*Ubuntu 24.04 LTS.*catkin' "$CLONE/rosbots" setup
}

case_no_sudo() {
  mv "$bare/usr/bin/sudo" "$bare/usr/bin/sudo.away"
  refuses 'needs root or sudo' "$CLONE/rosbots" setup
  mv "$bare/usr/bin/sudo.away" "$bare/usr/bin/sudo"
}

case_sudo_refused() {
  rm "$bare/etc/sudoers.d/newcomer"
  refuses 'sudo was refused' "$CLONE/rosbots" setup
}

case_no_network() {
  AROUND=("${ALONE[@]}")
  refuses 'cannot be reached' "$CLONE/rosbots" setup
}

case_apt_locked() {
  hold_lock /var/lib/dpkg/lock-frontend /var/lib/apt/lists/lock
  refuses 'another program is installing' env ROSBOTS_APT_WAIT=3 "$CLONE/rosbots" setup
}

# hold_lock FILE…: as a running apt-get does.
hold_lock() {
  mkdir -p "$bare/var/lib/apt/lists"
  python3 -c 'import fcntl, signal, sys
files = [open(name, "a") for name in sys.argv[1:]]
for file in files:
    fcntl.lockf(file, fcntl.LOCK_EX)
print("held", flush=True)
signal.pause()' "${@/#/$bare}" > "$bare.held" &
  HOLDER=$!
  until [[ -s $bare.held ]]; do sleep 0.1; done
}

case_no_disk_for_apt() {
  mount_full /var/cache/apt/archives
  chroot "$bare" mkdir -p /var/cache/apt/archives/partial
  refuses 'the disk is full' "$CLONE/rosbots" setup
}

# Ctrl-C while packages are unpacked, a power cut while pip installs; then it is run to its end.
case_interrupted() {
  interrupt INT "$CLONE/.ws/log/apt.log" '^Unpacking '
  interrupt KILL "$CLONE/.ws/log/pip.log" '^(Collecting|Processing) '
  works "$CLONE/rosbots" setup
}

# interrupt SIGNAL LOG PATTERN: begin the set-up, and end all its processes when the log has that.
interrupt() {
  local group
  rm -f "$bare.group" "$bare$2"
  env --default-signal=INT setsid -- \
    bash -c 'echo $$ > "$0.group"; source "$1"; bare=$0; inside newcomer "$2/rosbots" setup' \
    "$bare" "$repository/tools/bare_machine/root.bash" "$CLONE" > "$bare.output" 2>&1 &
  until grep -qE "$3" "$bare$2" 2> /dev/null || ! kill -0 $! 2> /dev/null; do sleep 0.2; done
  group=$(< "$bare.group")
  kill "-$1" -- "-$group" || true
  wait $! || true
  while pgrep -g "$group" > /dev/null; do sleep 0.2; done
}

# ---- after it -------------------------------------------------------------------------------

# The workspace of another clone, which everything fits in except the Python packages.
case_no_disk() {
  clone_into /home/newcomer/other
  mount_full /home/newcomer/other/.ws
  refuses 'the disk is full' /home/newcomer/other/rosbots setup
}

case_network_gone() {
  AROUND=("${ALONE[@]}")
  works "$CLONE/rosbots" "${IMPORT[@]}"
}

# Their programs come first on the PATH; each ends with an error here.
case_venv_conda_pyenv() {
  local theirs=/home/newcomer/.pyenv/shims program
  mkdir -p "$bare$theirs"
  for program in python python3 pip pip3 cmake make catkin_make roslaunch; do
    printf '#!/bin/sh\necho "$0 was called" >&2\nexit 1\n' > "$bare$theirs/$program"
    chmod +x "$bare$theirs/$program"
  done
  rm -rf "$bare$CLONE/.ws/devel" "$bare$CLONE/.ws/build" "$bare$CLONE/.ws/venv"
  works env "PATH=$theirs:/usr/bin:/bin" VIRTUAL_ENV=/home/newcomer/env CONDA_PREFIX=/opt/conda \
    CONDA_DEFAULT_ENV=base PYENV_ROOT=/home/newcomer/.pyenv PYENV_VERSION=3.9.1 \
    "$CLONE/rosbots" "${IMPORT[@]}"
}

case_spaces_and_umlauts() {
  clone_into '/home/newcomer/Größere Räume/rosbots'
  works '/home/newcomer/Größere Räume/rosbots/rosbots' exec gzserver --help
}

case_read_only_home() {
  mount -t tmpfs -o ro home "$bare/mnt"
  MOUNTED+=("$bare/mnt")
  works env HOME=/mnt "$CLONE/rosbots" "${IMPORT[@]}"
}

case_no_home() { works env -u HOME "$CLONE/rosbots" "${IMPORT[@]}"; }

case_second_clone() {
  clone_into /home/newcomer/second
  works /home/newcomer/second/rosbots exec sh -c \
    'rospack find gazebo_ros && test "$ROSBOTS_ROOT" = /home/newcomer/second'
}

# By a program that is no ROS master.
case_port_taken() {
  AROUND=("${ALONE[@]}")
  refuses 'has port 11311' bash -c "/usr/bin/python3 -m http.server 11311 > /dev/null 2>&1 & server=\$!
    trap 'kill \$server' EXIT
    until (: < /dev/tcp/localhost/11311) 2> /dev/null; do sleep 0.1; done
    $CLONE/rosbots launch gazebo_ros empty_world.launch gui:=false"
}

case_moved_clone() {
  rm -rf "$bare/home/newcomer/moved"
  mv "$bare/home/newcomer/second" "$bare/home/newcomer/moved"
  works /home/newcomer/moved/rosbots exec bash -c \
    'rospack find gazebo_ros && head -n 1 "$(type -P xacro)" && xacro --help'
}
