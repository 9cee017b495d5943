#!/usr/bin/env bash
# Prove that a bare Debian 12 suffices: make an empty root, clone the last commit into it, run
# ./rosbots there and show the time each command took. For maintainers; needs root, debootstrap.
#
#   tools/bare_machine_test.sh DIRECTORY [COMMAND…]     COMMAND: demo, test, … (default: demo test)
#
# The host's package sources, certificates and PIP_* variables are used inside as well; name
# further directories they need (a local wheel folder, say) in BARE_BIND, separated by spaces.
set -euo pipefail

if [[ $# -eq 0 || $UID -ne 0 ]]; then
  echo 'usage (as root): tools/bare_machine_test.sh DIRECTORY [COMMAND…]' >&2
  exit 2
fi
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
mkdir -p "$1"
bare=$(cd "$1" && pwd)
shift
[[ $# -gt 0 ]] || set -- demo test
clone=/home/newcomer/rosbots

leave() {
  local mounted
  for mounted in $(awk -v root="$bare/" 'index($2, root) == 1 {print $2}' /proc/mounts | sort -r); do
    umount -l "$mounted"
  done
}
trap leave EXIT

mirror=$(grep -rhE '^(deb |URIs:)' /etc/apt/sources.list* | grep -oE '[a-z]+://[^ ]*/debian/?( |$)' |
  head -n 1)
if [[ ! -e $bare/etc/debian_version ]]; then
  debootstrap --variant=minbase --include=ca-certificates bookworm "$bare" \
    "${mirror:?no Debian mirror is named in /etc/apt}"
fi
cp -a /etc/resolv.conf /etc/hosts "$bare/etc/"
rm -f "$bare/etc/apt/sources.list"
cp -a /etc/apt/. "$bare/etc/apt/"
cp -aL /etc/ssl/certs/ca-certificates.crt "$bare/etc/ssl/certs/"
for source in /etc/pip.conf "$HOME/.config/pip/pip.conf"; do
  if [[ -e $source ]]; then cp -aL "$source" "$bare/etc/pip.conf"; fi
done
mount -t proc proc "$bare/proc"
mount --rbind /dev "$bare/dev"
mount --make-rslave "$bare/dev"
for directory in ${BARE_BIND:-}; do
  mkdir -p "$bare$directory"
  mount --bind "$directory" "$bare$directory"
done

rm -rf "${bare:?}$clone"
git clone --quiet --no-hardlinks "$repository" "$bare$clone"
mapfile -t pip_variables < <(env | grep -E '^(PIP_|https?_proxy|no_proxy)' || true)
for command in "$@"; do
  start=$SECONDS
  # An empty environment, as on a machine that has never seen ROS.
  chroot "$bare" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C \
    "${pip_variables[@]}" "$clone/rosbots" "$command"
  echo "== ./rosbots $command took $((SECONDS - start)) s"
done
