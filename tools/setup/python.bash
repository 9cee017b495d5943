# Python packages of the chosen sets, in a virtual environment; sourced by tools/setup.bash.
#
# Debian's own packages show through; pip adds what Debian lacks.

# Its path has the version. Asked anew each time: a bare machine has none before its packages.
interpreter() { readlink -f /usr/bin/python3 || true; }

# shellcheck disable=SC2153  # LISTS is set by choose_sets
python_fingerprint() { echo "$LISTS $(interpreter) $WORKSPACE"; }

# The folder of wheels made here, which all clones share.
wheel_cache() {
  local cache=${XDG_CACHE_HOME:-${HOME:-/nonexistent}/.cache}/rosbots
  if ! mkdir -p "$cache" 2> /dev/null || [[ ! -w $cache ]]; then cache=$WORKSPACE/cache; fi
  echo "$cache"
}

# pybullet_wheel [OPTION]: make PyBullet's wheel, or only print its path (--path).
pybullet_wheel() {
  "$WORKSPACE/venv/bin/python" "$ROOT/tools/pybullet_build/wheel.py" "$@" "$(wheel_cache)"
}

# Anew where the interpreter or the folder is another one: the first lines of its programs name it.
make_environment() {
  if [[ -L $WORKSPACE/venv ]]; then rm "$WORKSPACE/venv"; fi  # it belongs to another workspace
  /usr/bin/python3 -m venv --system-site-packages --clear "$WORKSPACE/venv"
}

# A numpy of pip's in front of Debian's would not fit the modules that are built against that.
install_python() {
  local venv=$WORKSPACE/venv lists=$WORKSPACE/requirements wheel
  mkdir -p "$lists"
  wheel=$(pybullet_wheel --path)
  # Of the same version, pip would leave another wheel where it is.
  if ! is_done pybullet "$wheel"; then "$venv/bin/python" -m pip uninstall --yes pybullet; fi
  rm -rf "$venv"/lib/python3*/site-packages/{numpy,numpy-*,numpy.libs}
  /usr/bin/python3 -c 'import numpy; print("numpy==" + numpy.__version__)' > "$lists/numpy.txt"
  python_requirements "${CHOSEN[@]}" | grep -v '^pybullet==' > "$lists/python.txt"
  echo "$wheel" >> "$lists/python.txt"
  "$venv/bin/python" -m pip install --disable-pip-version-check --no-input \
    --constraint "$lists/numpy.txt" --requirement "$lists/python.txt"
  mark_done pybullet "$wheel"
}

set_up_python() {
  if [[ ! -x $WORKSPACE/venv/bin/pip ]] || ! is_done venv "$(interpreter) $WORKSPACE"; then
    phase 'Python environment' venv make_environment
    mark_done venv "$(interpreter) $WORKSPACE"
  fi
  if [[ ! -f $(pybullet_wheel --path) ]]; then
    phase "$(pybullet_wheel --title)" pybullet pybullet_wheel
  fi
  phase 'Python packages' pip install_python
}
