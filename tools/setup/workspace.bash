# The catkin workspace, or what serves where only the demo is set up; sourced by tools/setup.bash.

# Paths that neither catkin nor a '#!' line can hold (spaces, umlauts) get a workspace elsewhere.
find_workspace() {
  if [[ $ROOT =~ ^[A-Za-z0-9/._+@-]+$ ]]; then
    WORKSPACE=$ROOT/.ws
    return
  fi
  local cache=${XDG_CACHE_HOME:-${HOME:-/nonexistent}/.cache}
  if ! mkdir -p "$cache" 2> /dev/null || [[ ! -w $cache || ! $cache =~ ^[A-Za-z0-9/._+@-]+$ ]]; then
    cache=/var/tmp/rosbots-$UID
    mkdir -m 700 "$cache" 2> /dev/null || [[ -O $cache ]] || fail "$cache is somebody else's"
  fi
  WORKSPACE=$cache/rosbots-$(sha256sum <<< "$ROOT" | cut -c1-12)
  mkdir -p "$WORKSPACE"
  [[ $(readlink "$ROOT/.ws" || true) == "$WORKSPACE" ]] || ln -sfn "$WORKSPACE" "$ROOT/.ws"
}

# What catkin_make turns into files: build rules, manifests, message definitions, and scripts,
# by content for the former and by name for the latter (a script's devel copy calls the source).
workspace_fingerprint() (
  cd "$ROOT" || exit
  {
    echo "$ROOT $WORKSPACE"
    find . -maxdepth 1 -name CATKIN_IGNORE
    find . companions -maxdepth 2 \( -path './.*' -prune \) -o \
      \( -name CMakeLists.txt -o -name package.xml -o -name setup.py \) -print0 |
      sort -z | xargs -0 sha256sum
    find companions -type f \
      \( -name '*.msg' -o -name '*.srv' -o -name '*.action' -o -path '*/cmake/*' \) -print0 |
      sort -z | xargs -0 -r sha256sum tools/make_messages.py tools/messages.cmake \
      tools/setup/workspace.bash
    find scripts companions/*/scripts test/rostest -type f ! -name '*.pyc' 2> /dev/null | sort
  } | sha256sum
)

# Our robot's package is found in the clone, as the first source space of the workspace; CMake gets
# what it reads to configure it. A link to the clone, in the clone, would be a loop for `find -L`, by
# which rosrun searches the package; a second link to scripts/ would make its programs ambiguous.
# A clone that tools/link.py hides, or with a path that catkin cannot hold, is linked in parts.
# Links that are right stay: programs of this workspace may be running.
link_packages() {
  local source=$WORKSPACE/src ours=$WORKSPACE/src/rosbots_description path spaces=$WORKSPACE/src
  local -A links=()
  for path in "$ROOT"/companions/*/; do
    links[$source/$(basename "$path")]=${path%/}
  done
  [[ ! -L $ours ]] || rm "$ours"
  mkdir -p "$ours" "$WORKSPACE/devel"
  if [[ -e $ROOT/CATKIN_IGNORE || $WORKSPACE != "$ROOT/.ws" ]]; then
    for path in "$ROOT"/*; do
      [[ $path == */CATKIN_IGNORE ]] || links[$ours/$(basename "$path")]=$path
    done
  else
    spaces=$ROOT\;$spaces
    for path in "$ROOT"/{CMakeLists.txt,package.xml,setup.py,src}; do
      links[$ours/$(basename "$path")]=$path
    done
  fi
  while IFS= read -r path; do
    [[ -v links[$path] && $(readlink "$path") == "${links[$path]}" ]] || rm "$path"
  done < <(find "$source" -maxdepth 2 -type l ! -path "$source/CMakeLists.txt")
  for path in "${!links[@]}"; do
    [[ -L $path ]] || ln -s "${links[$path]}" "$path"
  done
  printf %s "$spaces" > "$WORKSPACE/devel/.catkin"
}

# A clean environment, so that a workspace the caller has sourced is not built into ours, and
# Debian's tools before those of pyenv and the like. It is only configured: all that there is to build
# is the code of messages, which is made on the way (tools/messages.cmake). Messages for Lisp are left
# out. The catkin of Debian 13 finds Python by another module of CMake, and so by another variable.
build_workspace() {
  local cache=$WORKSPACE/build/CMakeCache.txt
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$WORKSPACE/src" "$cache"; then
    rm -rf "$WORKSPACE/build" "$WORKSPACE/devel"
  fi
  link_packages
  local python=$WORKSPACE/venv/bin/python
  env -u CMAKE_PREFIX_PATH -u ROS_PACKAGE_PATH -u PYTHONPATH PATH="/usr/bin:/bin:$PATH" \
    ROS_LANG_DISABLE=genlisp ROS_PARALLEL_JOBS=-j1 \
    /usr/bin/catkin_make -C "$WORKSPACE" "-DPYTHON_EXECUTABLE=$python" "-DPython_EXECUTABLE=$python" \
    -DCATKIN_ENABLE_TESTING=OFF cmake_check_build_system
}

# ---- without a workspace: a compiler and catkin would take most of a newcomer's first minute ----

messages_fingerprint() {
  find "$ROOT/tools/make_messages.py" "$ROOT"/companions/*_msgs -type f -print0 | sort -z |
    xargs -0 sha256sum | sha256sum
}

make_messages() {
  rm -rf "$WORKSPACE/messages"
  /usr/bin/python3 "$ROOT/tools/make_messages.py" "$ROOT/companions" "$WORKSPACE/messages"
}
