# Debian packages of the chosen sets; sourced by tools/setup.bash.

packages_fingerprint() { echo "$LISTS $(stat -c %y /var/lib/dpkg/status 2> /dev/null)"; }

# Of the names on standard input those that are not installed.
missing_packages() {
  local wanted
  wanted=$(xargs)
  # shellcheck disable=SC2086
  comm -23 <(tr ' ' '\n' <<< "$wanted" | sort) \
    <(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' $wanted 2> /dev/null |
      sed -n 's/^ii //p' | sort)
}

as_root() {
  if [[ $UID -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

APT_OPTIONS=(-y --no-install-recommends -o DPkg::Lock::Timeout=120)

# A source that cannot be reached does no harm if the packages are known without it.
update_lists() {
  as_root apt-get update -o APT::Update::Error-Mode=any ||
    apt-get install --print-uris -qq "${APT_OPTIONS[@]}" "$@" > /dev/null
}

# What an interrupted installation has left, of ours or of anybody.
finish_interrupted() {
  if [[ -n $(dpkg --audit; ls /var/lib/dpkg/updates) ]]; then
    as_root dpkg --configure -a || true  # as far as their dependencies are there
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install --fix-broken "${APT_OPTIONS[@]}"
  fi
}

install_packages() {
  finish_interrupted
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install "${APT_OPTIONS[@]}" "$@"
}

# How many packages apt-get would install for these, and how much it would download.
amount() {
  apt-get install --print-uris -qq "${APT_OPTIONS[@]}" "$@" 2> /dev/null |
    awk '{size += $3} END {printf "%d to install, %d MB to download", NR, size / 1e6}'
}

set_up_packages() {
  local missing
  type -P dpkg-query apt-get > /dev/null ||
    fail 'apt-get is missing; this needs Debian 12 or 13, or a container of it (Containerfile)'
  mapfile -t missing < <(debian_packages "${CHOSEN[@]}" | missing_packages)
  if [[ ${#missing[@]} -gt 0 ]]; then
    [[ $DEBIAN == 1[23] ]] || fail 'this installs packages on Debian 12 and 13 only (or in a' \
      "container of it, see Containerfile); this machine, $(system_name), lacks ${missing[*]}"
    if [[ $UID -ne 0 ]]; then
      command -v sudo > /dev/null || fail "installing Debian packages needs root or sudo;" \
        "as root run: apt-get update && apt-get install --no-install-recommends ${missing[*]}"
      echo "==> ${#missing[@]} Debian packages are missing; sudo apt-get will install them"
      sudo -v || fail 'sudo was refused, so the missing Debian packages cannot be installed'
    fi
    phase 'List of Debian packages' apt_update update_lists "${missing[@]}"
    phase "Debian packages ($(amount "${missing[@]}"))" apt install_packages "${missing[@]}"
    # Interrupted, apt-get ends as if all was well.
    mapfile -t missing < <(missing_packages <<< "${missing[*]}")
    [[ ${#missing[@]} -eq 0 ]] ||
      fail 'the installation of Debian packages was interrupted; run this again'
  fi
}
