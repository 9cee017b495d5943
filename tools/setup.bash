# Install what is missing of the chosen sets, and only that; sourced by ./rosbots, needs ROOT.
#
# Three parts: Debian packages and Python packages, of each set, and the workspace (of the set demo
# alone, only the modules of messages); of the set navigation, also its stack. A part is done when
# its stamp file holds the fingerprint of everything it was made from; comparing these costs
# milliseconds.

source "$ROOT/tools/setup/progress.bash"
source "$ROOT/tools/setup/sets.bash"
source "$ROOT/tools/setup/debian.bash"
source "$ROOT/tools/setup/python.bash"
source "$ROOT/tools/setup/workspace.bash"
source "$ROOT/tools/setup/navigation.bash"

is_done() { [[ -f $WORKSPACE/stamps/$1 && $(< "$WORKSPACE/stamps/$1") == "$2" ]]; }

mark_done() {
  mkdir -p "$WORKSPACE/stamps"
  echo "$2" > "$WORKSPACE/stamps/$1"
}

# are_done PART FINGERPRINT: whether that part of all chosen sets is.
are_done() {
  local set
  for set in "${CHOSEN[@]}"; do
    is_done "$1.$set" "$2" || return 1
  done
}

mark_all_done() {
  local set
  for set in "${CHOSEN[@]}"; do mark_done "$1.$set" "$2"; done
}

# Read the lists: set CHOSEN, and LISTS to a hash of everything from which sets are installed.
choose_sets() {
  find_platform
  with_included "$@"
  LISTS=$(cat "$REQUIREMENTS"/* "$ROOT"/tools/pybullet_build/*.* <(echo "$DEBIAN $ARCHITECTURE") |
    sha256sum)
}

packages_done() { are_done packages "$(packages_fingerprint)"; }

python_done() {
  [[ -x $WORKSPACE/venv/bin/python ]] && are_done python "$(python_fingerprint)"
}

has_workspace() { [[ " ${CHOSEN[*]} " == *' base '* ]]; }

workspace_done() {
  if has_workspace; then
    [[ -f $WORKSPACE/devel/setup.bash ]] && is_done workspace "$(workspace_fingerprint)"
  else
    is_done messages "$(messages_fingerprint)"
  fi
}

set_up_workspace() {
  if has_workspace; then
    phase 'Workspace' catkin_make build_workspace
    mark_done workspace "$(workspace_fingerprint)"
  else
    phase 'Messages' messages make_messages
    mark_done messages "$(messages_fingerprint)"
  fi
}

# Say in a line what a set is for and how large it is.
announce() {
  local set
  for set in "${CHOSEN[@]}"; do
    if ! is_done "python.$set" "$(python_fingerprint)"; then echo "==> set $set: $(purpose "$set")"; fi
  done
}

# set_up SET…: install what these sets, and those they include, lack.
set_up() {
  find_workspace
  choose_sets "$@"
  if packages_done && python_done && workspace_done && navigation_done; then return; fi
  mkdir -p "$WORKSPACE" || fail "cannot write to $WORKSPACE"
  trap stop_progress EXIT
  # One at a time: in a second terminal this waits for the first.
  { exec {lock}> "$WORKSPACE/lock"; } 2> /dev/null ||
    fail "something is to be set up, and $WORKSPACE cannot be written"
  if ! flock -n "$lock"; then
    echo '==> waiting for the set-up that runs in another terminal'
    flock "$lock"
  fi
  announce
  if ! packages_done; then
    set_up_packages
    mark_all_done packages "$(packages_fingerprint)"
  fi
  if ! python_done; then
    set_up_python
    mark_all_done python "$(python_fingerprint)"
  fi
  if ! workspace_done; then set_up_workspace; fi
  if ! navigation_done; then set_up_navigation; fi
  exec {lock}>&-
}
