# Install what is missing, and only that; sourced by ./rosbots, needs ROOT. Sets WORKSPACE.
#
# Three phases: Debian packages, Python packages, workspace. A phase is done when its stamp file
# holds the fingerprint of everything it was made from; comparing these costs milliseconds.

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

fail() {
  echo "rosbots: $*" >&2
  exit 1
}

# ---- progress -------------------------------------------------------------------------------

TICKER=

stop_ticker() {
  if [[ -n $TICKER ]]; then
    kill "$TICKER" 2> /dev/null || true
    wait "$TICKER" 2> /dev/null || true
    TICKER=
  fi
}

# phase TITLE LOG COMMAND…: run a command with one line of progress; its output goes to the log.
phase() {
  local title=$1 log=$WORKSPACE/log/$2.log status
  shift 2
  mkdir -p "$WORKSPACE/log"
  if [[ -t 1 ]]; then
    tick "$title" &
    TICKER=$!
  else
    echo "==> $title …"
  fi
  SECONDS=0
  # Behind '||' or 'if' the shell would ignore failures inside the command.
  set +e
  (set -e; "$@") > "$log" 2>&1
  status=$?
  set -e
  stop_ticker
  if [[ -t 1 ]]; then printf '\r\e[K'; fi
  if [[ $status -ne 0 ]]; then
    echo "==> $title: failed after $SECONDS s; the end of $log:" >&2
    tail -n 25 "$log" | sed 's/^/    /' >&2
    exit 1
  fi
  echo "==> $title: done in $SECONDS s"
}

tick() {
  local start=$SECONDS
  while :; do
    printf '\r\e[K==> %s … %d s' "$1" $((SECONDS - start))
    sleep 1
  done
}

# ---- stamps ---------------------------------------------------------------------------------

is_done() { [[ -f $WORKSPACE/stamps/$1 && $(< "$WORKSPACE/stamps/$1") == "$2" ]]; }

mark_done() {
  mkdir -p "$WORKSPACE/stamps"
  echo "$2" > "$WORKSPACE/stamps/$1"
}

packages_fingerprint() {
  cat "$ROOT/apt-packages.txt" <(stat -c %y /var/lib/dpkg/status 2> /dev/null) | sha256sum
}

python_fingerprint() {
  sha256sum < <(cat "$ROOT/requirements.txt"; readlink -f /usr/bin/python3; echo "$WORKSPACE")
}

# What catkin_make turns into files: build rules, manifests, message definitions, and scripts,
# by content for the former and by name for the latter (a script's devel copy calls the source).
workspace_fingerprint() (
  cd "$ROOT"
  {
    echo "$ROOT $WORKSPACE"
    find . -maxdepth 1 -name CATKIN_IGNORE
    find . companions -maxdepth 2 \( -path './.*' -prune \) -o \
      \( -name CMakeLists.txt -o -name package.xml -o -name setup.py \) -print0 |
      sort -z | xargs -0 sha256sum
    find companions \( -name '*.msg' -o -name '*.srv' \) -print0 | sort -z | xargs -0 -r sha256sum
    find scripts companions/*/scripts test/rostest -type f 2> /dev/null | sort
  } | sha256sum
)

# ---- Debian packages ------------------------------------------------------------------------

missing_packages() {
  local wanted
  wanted=$(sed 's/#.*//' "$ROOT/apt-packages.txt" | xargs)
  # shellcheck disable=SC2086
  comm -23 <(tr ' ' '\n' <<< "$wanted" | sort) \
    <(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' $wanted 2> /dev/null |
      sed -n 's/^ii //p' | sort)
}

as_root() {
  if [[ $UID -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

install_packages() {
  local options=(-y --no-install-recommends -o DPkg::Lock::Timeout=300)
  as_root apt-get update
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install "${options[@]}" "$@"
}

set_up_packages() {
  local missing
  if [[ -r /etc/os-release ]] && ! grep -qx 'VERSION_ID="12"' /etc/os-release; then
    echo "rosbots: this is made for Debian 12, and this machine is" \
      "$(. /etc/os-release && echo "${PRETTY_NAME:-unknown}"); trying all the same" >&2
  fi
  command -v dpkg-query > /dev/null && command -v apt-get > /dev/null ||
    fail 'apt-get is missing; this needs Debian 12 (or a container of it)'
  mapfile -t missing < <(missing_packages)
  if [[ ${#missing[@]} -gt 0 ]]; then
    if [[ $UID -ne 0 ]]; then
      command -v sudo > /dev/null || fail "installing Debian packages needs root or sudo;" \
        "as root run: apt-get update && apt-get install --no-install-recommends ${missing[*]}"
      echo "==> ${#missing[@]} Debian packages are missing; sudo apt-get will install them"
      sudo -v || fail 'sudo was refused, so the missing Debian packages cannot be installed'
    fi
    phase "Debian packages (${#missing[@]} missing)" apt install_packages "${missing[@]}"
  fi
  mark_done packages "$(packages_fingerprint)"
}

# ---- Python packages ------------------------------------------------------------------------

# Debian's own numpy, lxml and ROS modules show through; pip adds what Debian lacks. An earlier
# numpy of pip's in front of Debian's would not fit the modules built against that.
install_python() {
  local venv=$WORKSPACE/venv
  /usr/bin/python3 -m venv --system-site-packages --upgrade "$venv"
  rm -rf "$venv"/lib/python3*/site-packages/{numpy,numpy-*,numpy.libs}
  local constraint=$WORKSPACE/stamps/numpy.txt
  mkdir -p "$WORKSPACE/stamps"
  /usr/bin/python3 -c 'import numpy; print("numpy==" + numpy.__version__)' > "$constraint"
  "$venv/bin/python" -m pip install --disable-pip-version-check --no-input \
    --constraint "$constraint" --requirement "$ROOT/requirements.txt"
}

# ---- workspace ------------------------------------------------------------------------------

link_packages() {
  local package
  rm -rf "$WORKSPACE/src/rosbots_description"
  mkdir -p "$WORKSPACE/src"
  find "$WORKSPACE/src" -maxdepth 1 -type l -delete
  if [[ -e $ROOT/CATKIN_IGNORE ]]; then  # tools/link.py hides the clone as a whole, not its parts
    mkdir "$WORKSPACE/src/rosbots_description"
    find "$ROOT" -mindepth 1 -maxdepth 1 ! -name '.*' ! -name CATKIN_IGNORE \
      -exec ln -s -t "$WORKSPACE/src/rosbots_description" {} +
  else
    ln -s "$ROOT" "$WORKSPACE/src/rosbots_description"
  fi
  for package in "$ROOT"/companions/*/; do
    ln -s "${package%/}" "$WORKSPACE/src/$(basename "$package")"
  done
}

# A clean environment, so that a workspace the caller has sourced is not built into ours, and
# Debian's tools before those of pyenv and the like.
build_workspace() {
  local cache=$WORKSPACE/build/CMakeCache.txt
  if [[ -f $cache ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$WORKSPACE/src" "$cache"; then
    rm -rf "$WORKSPACE/build" "$WORKSPACE/devel"
  fi
  link_packages
  env -u CMAKE_PREFIX_PATH -u ROS_PACKAGE_PATH -u PYTHONPATH PATH="/usr/bin:/bin:$PATH" \
    /usr/bin/catkin_make -C "$WORKSPACE" "-DPYTHON_EXECUTABLE=$WORKSPACE/venv/bin/python" \
    -DCATKIN_ENABLE_TESTING=OFF
}

# ---- all ------------------------------------------------------------------------------------

all_done() {
  [[ -x $WORKSPACE/venv/bin/python && -f $WORKSPACE/devel/setup.bash ]] || return 1
  is_done packages "$(packages_fingerprint)" && is_done python "$(python_fingerprint)" &&
    is_done workspace "$(workspace_fingerprint)"
}

set_up() {
  find_workspace
  if all_done; then return; fi
  mkdir -p "$WORKSPACE" || fail "cannot write to $WORKSPACE"
  trap stop_ticker EXIT
  # One at a time: in a second terminal this waits for the first.
  { exec {lock}> "$WORKSPACE/lock"; } 2> /dev/null ||
    fail "something is to be set up, and $WORKSPACE cannot be written"
  if ! flock -n "$lock"; then
    echo '==> waiting for the set-up that runs in another terminal'
    flock "$lock"
  fi
  is_done packages "$(packages_fingerprint)" || set_up_packages
  if [[ ! -x $WORKSPACE/venv/bin/python ]] || ! is_done python "$(python_fingerprint)"; then
    phase 'Python packages' pip install_python
    mark_done python "$(python_fingerprint)"
  fi
  if [[ ! -f $WORKSPACE/devel/setup.bash ]] || ! is_done workspace "$(workspace_fingerprint)"; then
    phase 'Workspace' catkin_make build_workspace
    mark_done workspace "$(workspace_fingerprint)"
  fi
  exec {lock}>&-
}
