# Messages and progress of the set-up; sourced by tools/setup.bash.

fail() {
  echo "rosbots: $*" >&2
  exit 1
}

# Causes that the user can cure: how a log names one, and the sentence about it.
CAUSES=(
  'Could not get lock|Unable to acquire the dpkg frontend lock|is another process using it'
  'another program is installing packages; run this again when it has ended'
  'No space left on device|enough free space|Disk quota exceeded'
  'the disk is full; make room, and run this again'
  "unable to access 'https?:|Could not read from remote repository"
  'a server of sources cannot be reached; connect this machine to the network, and run this again'
  'Temporary failure (in name )?resol|Could not (resolve|connect)|[Nn]etwork is unreachable|new connection'
  'a server of packages cannot be reached; connect this machine to the network, and run this again'
  'Permission denied|Read-only file system'
  'a folder cannot be written'
)

# explain LOG: the sentence about its cause; fails if that is none of these. venv says nothing of a
# full disk.
explain() {
  local i
  if [[ $(df --output=avail -k "$WORKSPACE" | tail -n 1) -lt 1000 ]]; then
    echo 'the disk is full; make room, and run this again'
    return
  fi
  for ((i = 0; i < ${#CAUSES[@]}; i += 2)); do
    if grep -qE "${CAUSES[i]}" "$1"; then
      echo "${CAUSES[i + 1]}"
      return
    fi
  done
  return 1
}

# phase TITLE LOG COMMAND…: run a command with its progress in one line; its output goes to a log.
phase() {
  local title=$1 log=$WORKSPACE/log/$2.log status cause
  shift 2
  mkdir -p "$WORKSPACE/log"
  : > "$log"
  if [[ ! -t 1 ]]; then echo "==> $title …"; fi
  show_progress "$title" "$log" &
  TICKER=$!
  SECONDS=0
  # Behind '||' or 'if' the shell would ignore failures inside the command.
  set +e
  (set -e; "$@") > "$log" 2>&1
  status=$?
  set -e
  stop_progress
  if [[ -t 1 ]]; then printf '\r\e[K'; fi
  if [[ $status -ne 0 ]]; then
    if cause=$(explain "$log"); then fail "$title: $cause (details: $log)"; fi
    echo "==> $title: failed after $SECONDS s; the end of $log:" >&2
    tail -n 25 "$log" | sed 's/^/    /' >&2
    exit 1
  fi
  echo "==> $title: done in $SECONDS s"
}

TICKER=

stop_progress() {
  if [[ -n $TICKER ]]; then
    kill "$TICKER" 2> /dev/null || true
    wait "$TICKER" 2> /dev/null || true
    TICKER=
  fi
}

# Once a second on a terminal, elsewhere a line every half a minute.
show_progress() {
  local start=$SECONDS pause=30 form='==> %s … %d s%s\n' never
  if [[ -t 1 ]]; then pause=1 form='\r\e[K==> %s … %d s%s'; fi
  exec {never}<> <(:)  # to wait without a process that could outlive this one
  if [[ ! -t 1 ]]; then read -rt "$pause" -u "$never" || true; fi
  while :; do
    # shellcheck disable=SC2059
    printf "$form" "$1" $((SECONDS - start)) "$(percentage "$2")"
    read -rt "$pause" -u "$never" || true
  done
}

# The latest percentage in the log of a build by CMake.
percentage() {
  tail -c 2000 "$1" | sed -nE 's/^\[ *([0-9]+%)\].*/, \1/p' | tail -n 1
}
