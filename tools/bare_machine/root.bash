# An empty Debian; sourced by tools/bare_machine_test.sh, needs release, bare and repository.

CLONE=/home/newcomer/rosbots
# A network that has only this machine.
ALONE=(unshare --net python3 -c 'import fcntl, os, socket, struct, sys
fcntl.ioctl(socket.socket(), 0x8914, struct.pack("16sH14s", b"lo", 1, b""))  # SIOCSIFFLAGS: up
os.execvp(sys.argv[1], sys.argv[1:])')
AROUND=()  # what a command inside is started by: unshare --net …

suite() { if [[ $release == 12 ]]; then echo bookworm; else echo trixie; fi; }

# Make the root if there is none, and mount what programs expect.
enter() {
  if [[ ! -e $bare/etc/debian_version ]]; then
    if [[ ! -e $bare.tar ]]; then
      mkdir "$bare/sources"
      write_sources "$bare/sources"
      mmdebstrap --variant=minbase --include=ca-certificates,sudo "$(suite)" "$bare.tar" \
        "$bare"/sources/*
      rm -r "$bare/sources"
    fi
    tar -C "$bare" -xpf "$bare.tar"
    chroot "$bare" useradd --create-home --shell /bin/bash newcomer
    chmod 755 "$bare/home/newcomer"  # Debian 13's are private: root's sandbox could not look in
  fi
  cp -a /etc/resolv.conf /etc/hosts "$bare/etc/"
  rm -f "$bare/etc/apt/sources.list" "$bare"/etc/apt/sources.list.d/*
  cp -a /etc/apt/apt.conf.d/. "$bare/etc/apt/apt.conf.d/"
  if [[ -n ${BARE_ARCHIVES:-} ]]; then rm -f "$bare/etc/apt/apt.conf.d/docker-clean"; fi
  write_sources "$bare/etc/apt/sources.list.d"
  cp -aL /etc/ssl/certs/ca-certificates.crt "$bare/etc/ssl/certs/"
  local source
  for source in /etc/pip.conf "$HOME/.config/pip/pip.conf"; do
    if [[ -e $source ]]; then cp -aL "$source" "$bare/etc/pip.conf"; fi
  done
  mount -t proc proc "$bare/proc"
  mount --rbind /dev "$bare/dev"
  for source in ${BARE_BIND:-}; do
    mkdir -p "$bare$source"
    mount --bind "$source" "$bare$source"
  done
  if [[ -n ${BARE_ARCHIVES:-} ]]; then
    mount --bind "$BARE_ARCHIVES" "$bare/var/cache/apt/archives"
  fi
}

# write_sources FOLDER: the host's package sources, for the release that is tested.
write_sources() {
  local file
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.{sources,list}; do
    if [[ -e $file ]]; then
      sed -E "s/\b(bookworm|trixie)/$(suite)/g" "$file" > "$1/${file##*/}"
    fi
  done
}

# clone_into FOLDER: the last commit, there, owned by the newcomer.
clone_into() {
  rm -rf "${bare:?}$1"
  git clone --quiet --no-hardlinks "$repository" "$bare$1"
  chroot "$bare" chown -R newcomer: "$1"
}

# With another root for a namespace of mounts: below a chroot, no program may make a sandbox.
PIVOT='mount --rbind "$0" "$0" && cd "$0" && mkdir -p .old && pivot_root . .old && cd / &&
umount -l /.old && exec "$@"'

# inside USER COMMAND…: run in an empty environment, as on a machine that has never seen ROS.
inside() {
  local user=$1 home=/root pip_variables
  shift
  if [[ $user != root ]]; then home=/home/$user; fi
  mapfile -t pip_variables < <(env | grep -E '^(PIP_|https?_proxy|no_proxy)' || true)
  "${AROUND[@]}" unshare --mount --propagation private sh -c "$PIVOT" "$bare" \
    runuser -u "$user" -- env -i HOME="$home" LANG=C \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin "${pip_variables[@]}" "$@"
}
