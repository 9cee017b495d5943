#!/usr/bin/env bash
# Prove that a bare Debian suffices: make an empty root, clone the last commit into it, run ./rosbots
# there and show the time that each command took. For maintainers; needs root and mmdebstrap.
#
#   tools/bare_machine_test.sh 12|13 DIRECTORY [COMMAND…]   each a command of ./rosbots, with its
#                                                           arguments (default: demo test)
#   tools/bare_machine_test.sh 12|13 DIRECTORY failures [NAME…]
#                                 everything that goes wrong on a newcomer's machine, or what is named
#   tools/bare_machine_test.sh 12|13 DIRECTORY container    the steps of the Containerfile
#
# The empty root is kept as DIRECTORY.tar, from which another one costs seconds: remove DIRECTORY.
# The host's package sources, certificates and PIP_* variables are used inside as well; name further
# directories they need (a local wheel folder, say) in BARE_BIND, separated by spaces, and a folder
# that keeps downloaded Debian packages in BARE_ARCHIVES.
set -euo pipefail

if [[ $# -lt 2 || ! $1 =~ ^1[23]$ || $UID -ne 0 ]]; then
  echo 'usage (as root): tools/bare_machine_test.sh 12|13 DIRECTORY [COMMAND…]' >&2
  exit 2
fi
# What is mounted in the root is not seen from outside, where someone may remove it, and ends with
# these processes however they end.
if [[ -z ${BARE_MOUNTS:-} ]]; then
  BARE_MOUNTS=private exec unshare --mount --propagation private "$0" "$@"
fi
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$repository/tools/bare_machine/root.bash"
source "$repository/tools/bare_machine/failures.bash"
source "$repository/tools/bare_machine/container.bash"
release=$1
mkdir -p "$2"
bare=$(cd "$2" && pwd)
shift 2
enter
[[ $# -gt 0 ]] || set -- demo test

if [[ $1 == failures ]]; then
  shift
  run_failures "$@"
elif [[ $1 == container ]]; then
  run_container_steps
else
  clone_into "$CLONE"
  for command in "$@"; do
    start=$SECONDS
    # shellcheck disable=SC2086
    inside root "$CLONE/rosbots" $command
    echo "== ./rosbots $command took $((SECONDS - start)) s"
  done
fi
