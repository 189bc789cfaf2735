#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# bare_debian_demo.sh [FOLDER]
#
# Runs `./run demo` in a bare Debian 12 and prints the time: makes a minimal system in
# FOLDER (build/bare-debian) with debootstrap, with the package sources and the npm registry
# of this machine, copies the commit HEAD to its /marey, and calls ./run demo there. The
# time includes the installation of packages. Bar: 10 minutes of wall time on two idle
# cores. Needs root, the network, some 4 GB of disk, and the package debootstrap. The system
# is removed at the end, unless KEEP=true.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."

readonly ROOT=$(realpath -m "${1:-build/bare-debian}")
readonly BAR_S=600

fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

[[ $EUID -eq 0 ]] || fail "a chroot needs root. Next: run it as root"
command -v debootstrap >/dev/null ||
  fail "debootstrap is missing. Next: apt-get install debootstrap"
[[ ! -e $ROOT ]] || fail "$ROOT exists. Next: remove it, or name another folder"

# The first source of packages of Debian 12 that apt knows on this machine.
mirror() {
  apt-get indextargets --format '$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Identifier: Packages' |
    awk '$2 == "bookworm" && $3 == "main" { print $1; exit }'
}

unmount() {
  local at
  for at in dev/pts dev sys proc; do
    mountpoint -q "$ROOT/$at" && umount -l "$ROOT/$at"
  done
  return 0
}

clean_up() {
  unmount
  [[ ${KEEP:-} == true ]] || rm -rf --one-file-system "$ROOT"
}
trap clean_up EXIT

make_system() {
  local source
  source=$(mirror)
  debootstrap --variant=minbase --include=ca-certificates bookworm "$ROOT" \
    "${source:-http://deb.debian.org/debian}" >&2
  # Sources, their keys and settings; no passwords.
  rm -rf "$ROOT/etc/apt/sources.list" "$ROOT/etc/apt/sources.list.d"
  local part
  for part in sources.list sources.list.d keyrings trusted.gpg.d preferences.d apt.conf.d; do
    [[ ! -e /etc/apt/$part ]] || cp -a "/etc/apt/$part" "$ROOT/etc/apt/"
  done
  cp /etc/resolv.conf /etc/hosts "$ROOT/etc/"
  [[ ! -e /etc/ssl/certs/ca-certificates.crt ]] ||
    cp -L /etc/ssl/certs/ca-certificates.crt "$ROOT/etc/ssl/certs/"
  mkdir "$ROOT/marey"
  git -c safe.directory='*' archive HEAD | tar -x -C "$ROOT/marey"
  mount -t proc proc "$ROOT/proc"
  mount --rbind /sys "$ROOT/sys"
  mount --make-rslave "$ROOT/sys"
  mount --rbind /dev "$ROOT/dev"
  mount --make-rslave "$ROOT/dev"
}

# The registry of npm on this machine, if it has npm.
registry=$(npm config get registry 2>/dev/null || true)

make_system
begin=$EPOCHREALTIME
before=$(times | tail -1)
chroot "$ROOT" /usr/bin/env -i HOME=/ PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
  ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
  ${no_proxy:+no_proxy="$no_proxy"} ${registry:+npm_config_registry="$registry"} \
  /marey/run demo
end=$EPOCHREALTIME
printf 'processor time (user, system) before: %s, after: %s\n' "$before" "$(times | tail -1)"
awk -v begin="$begin" -v end="$end" -v bar="$BAR_S" 'BEGIN {
  printf "wall time: %.0f s (bar %d s)\n", end - begin, bar; exit end - begin > bar }'
