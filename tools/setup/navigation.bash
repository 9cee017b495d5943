# The navigation stack, which Debian lacks: sources by vcstool, our patches, and a workspace of its own
# below that of this project; sourced by tools/setup.bash.

NAVIGATION=$ROOT/tools/navigation
MEMORY_PER_COMPILER=1500  # [MB]; 0.9 GB were measured

has_navigation() { [[ " ${CHOSEN[*]} " == *' navigation '* ]]; }

navigation_fingerprint() {
  {
    find -L "$NAVIGATION" -type f ! -path '*/__pycache__/*' -print0 | sort -z | xargs -0 cat
    echo "$DEBIAN $WORKSPACE"
  } | sha256sum
}

navigation_done() { ! has_navigation || is_done navigation "$(navigation_fingerprint)"; }

# As many as there are processors, unless memory is short.
compilers() {
  awk -v most="$(nproc)" -v each="$MEMORY_PER_COMPILER" '
    /^MemAvailable:/ {n = int($2 / 1000 / each); print n < 1 ? 1 : n < most ? n : most}' \
    "${1:-/proc/meminfo}"
}

# get_sources FOLDER: what navigation.repos names, patched.
get_sources() {
  local patch
  rm -rf "$1"
  mkdir -p "$1"
  GIT_TERMINAL_PROMPT=0 /usr/bin/vcs import --shallow --input "$NAVIGATION/navigation.repos" "$1"
  for patch in "$NAVIGATION"/patches/*.patch; do
    git -C "$1/$(basename "$patch" .patch)" apply --unidiff-zero "$patch"
  done
}

# build_navigation FOLDER: the workspace in it, from FOLDER/sources.
build_navigation() {
  local name folder built targets=
  rm -rf "$1/src"
  mkdir -p "$1/src"
  /usr/bin/python3 "$NAVIGATION/build_plan.py" "$1/sources" > "$1/plan"
  while read -r name folder built; do
    ln -s "$folder" "$1/src/$name"
    targets+=" $built"
  done < "$1/plan"
  read -ra targets <<< "$targets"
  ln -s "$NAVIGATION/navigation_targets" "$1/src/"
  env -u CMAKE_PREFIX_PATH -u ROS_PACKAGE_PATH -u PYTHONPATH PATH="/usr/bin:/bin:$PATH" \
    ROS_LANG_DISABLE=genlisp:geneus:gennodejs \
    /usr/bin/catkin_make -C "$1" "-j$(compilers)" -DCMAKE_BUILD_TYPE=Release \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython_EXECUTABLE=/usr/bin/python3 \
    -DCATKIN_ENABLE_TESTING=OFF "-DNAVIGATION_TARGETS=$(IFS=';'; echo "${targets[*]}")" navigation_targets
}

set_up_navigation() {
  local place=$WORKSPACE/navigation sources
  sources=$(cat "$NAVIGATION/navigation.repos" "$NAVIGATION"/patches/* | sha256sum)
  if ! is_done navigation_sources "$sources"; then
    phase 'Sources of the navigation stack (GitHub)' navigation_sources get_sources "$place/sources"
    mark_done navigation_sources "$sources"
  fi
  phase "Navigation stack, by $(compilers) compilers" navigation build_navigation "$place"
  mark_done navigation "$(navigation_fingerprint)"
}
