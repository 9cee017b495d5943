# The sets of requirements, as they are on this platform; sourced by tools/setup.bash, needs ROOT.
#
# Of each set requirements/ has SET.pip, the Python packages, and perhaps SET.apt, Debian packages.
# '-r OTHER.pip' includes another set. The first line of SET.pip says what a set is for, and its
# size. requirements/debian.txt has the Python packages that come from Debian instead of PyPI.

REQUIREMENTS=$ROOT/requirements
# shellcheck disable=SC2034  # ./rosbots checks names by it
SETS=(demo base web gym batch navigation doc test bench)

# Set DEBIAN to 12 or 13, and to nothing on another system; ARCHITECTURE to Debian's name of it.
find_platform() {
  DEBIAN=
  if [[ -r /etc/os-release ]]; then
    DEBIAN=$(. /etc/os-release && if [[ ${ID:-} == debian ]]; then echo "${VERSION_ID:-}"; fi)
  fi
  case $HOSTTYPE in
    x86_64) ARCHITECTURE=amd64 ;;
    aarch64) ARCHITECTURE=arm64 ;;
    *) ARCHITECTURE=$HOSTTYPE ;;
  esac
}

system_name() { (. /etc/os-release 2> /dev/null && echo "${PRETTY_NAME:-}") || uname -o; }

# with_included SET…: fill CHOSEN with these sets and those they include, each once, first what
# is included.
with_included() {
  CHOSEN=()
  local name
  for name in "$@"; do choose "$name"; done
}

choose() {
  local word file
  if [[ " ${CHOSEN[*]} " == *" $1 "* ]]; then return; fi
  while read -r word file _; do
    if [[ $word == -r ]]; then choose "${file%.pip}"; fi
  done < "$REQUIREMENTS/$1.pip"
  CHOSEN+=("$1")
}

# purpose SET: what it is for, and how large it is.
purpose() {
  local line
  read -r line < "$REQUIREMENTS/$1.pip"
  echo "${line#\# }"
}

entries() { sed -E 's/(^|[[:space:]])#.*//; /^[[:space:]]*$/d; /^-r /d' "$1"; }

# Whether one of these versions or architectures is that of this machine; true if none is given.
is_here() {
  local condition
  if [[ $# -eq 0 ]]; then return; fi
  for condition in "$@"; do
    if [[ $condition == "$DEBIAN" || $condition == "$ARCHITECTURE" ]]; then return; fi
  done
  return 1
}

# Fill SERVED: of a Python package the Debian package that serves for it here.
declare -A SERVED
read_debian_table() {
  local name package versions
  SERVED=()
  while read -r name package versions; do
    # shellcheck disable=SC2086
    if is_here $versions; then SERVED[$name]=$package; fi
  done < <(entries "$REQUIREMENTS/debian.txt")
}

# debian_packages SET…: names, one per line.
debian_packages() {
  local set name conditions requirement
  read_debian_table
  for set in "$@"; do
    if [[ -e $REQUIREMENTS/$set.apt ]]; then
      while read -r name conditions; do
        # shellcheck disable=SC2086
        if is_here $conditions; then echo "$name"; fi
      done < <(entries "$REQUIREMENTS/$set.apt")
    fi
    while read -r requirement; do
      name=${requirement%%[=<>; ]*}
      if [[ -n ${SERVED[$name]:-} ]]; then echo "${SERVED[$name]}"; fi
    done < <(entries "$REQUIREMENTS/$set.pip")
  done | sort -u
}

# python_requirements SET…: what pip installs here, one requirement per line.
python_requirements() {
  local set requirement
  read_debian_table
  for set in "$@"; do
    while read -r requirement; do
      if [[ -z ${SERVED[${requirement%%[=<>; ]*}]:-} ]]; then echo "$requirement"; fi
    done < <(entries "$REQUIREMENTS/$set.pip")
  done | sort -u
}
