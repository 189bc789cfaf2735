#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# fetch_guest_kernel.sh FOLDER: Debian's kernel for the emulated machine, with the modules
# that simulate cameras: vivid, which it ships, and v4l2loopback, which is built here.
# Nothing is installed. FOLDER then has vmlinuz, modules/*.ko and modules/order; it is left
# alone when it has them. Needs apt-get with package lists, kmod, make and the gcc of
# Debian's kernel.
set -euo pipefail

mkdir -p "$1"
folder=$(cd "$1" && pwd)
readonly folder
[[ ! -e $folder/modules/order ]] || exit 0

# Newest kernel of this release: linux-image-amd64 depends on one by its full name.
image=$(apt-cache depends linux-image-amd64 | awk '/Depends:/ { print $2; exit }')
readonly release=${image#linux-image-}
if [[ -z $image || $release != *-amd64 ]]; then
  echo "skipped: apt knows no linux-image-amd64; apt-get update" >&2
  exit 1
fi
readonly common=linux-headers-${release%-amd64}-common
version=${release%%-*}
readonly kbuild=linux-kbuild-${version%.*}

readonly work=$folder/partial
rm -rf "$work"
mkdir -p "$work/tree"
cd "$work"
# As root apt warns that its own user cannot write here.
apt-get download -qq -o APT::Sandbox::User=root \
  "$image" "linux-headers-$release" "$common" "$kbuild" v4l2loopback-dkms

unpack() {
  dpkg-deb --fsys-tarfile "$1"_*.deb | tar -x -C tree --wildcards "${@:2}"
}
unpack "$image" './boot/vmlinuz-*' "./lib/modules/$release/kernel/drivers/media/*" \
  "./lib/modules/$release/modules.*"
unpack "linux-headers-$release" './usr/src/*'
unpack "$common" './usr/src/*'
unpack "$kbuild" './usr/lib/*'
unpack v4l2loopback-dkms './usr/src/*'

# Its makefile would install the module into the running system.
headers=$work/tree/usr/src/linux-headers-$release
echo "include $work/tree/usr/src/$common/Makefile" >"$headers/Makefile"
loopback=$(echo "$work"/tree/usr/src/v4l2loopback-*)
make -s -C "$headers" M="$loopback" modules >make.log 2>&1 || {
  cat make.log >&2
  exit 1
}

depmod -b "$work/tree" "$release"
mkdir -p "$work/modules"
modprobe -d "$work/tree" -S "$release" --show-depends vivid |
  awk '$1 == "insmod" { print $2 }' >"$work/paths"
echo "$loopback/v4l2loopback.ko" >>"$work/paths"
xargs -a "$work/paths" cp -t "$work/modules"
strip --strip-debug "$work"/modules/*.ko
xargs -a "$work/paths" -n 1 basename >"$work/modules/order"
cp "$work/tree/boot/vmlinuz-$release" "$folder/vmlinuz"
rm -rf "$folder/modules"
mv "$work/modules" "$folder/modules"
cd "$folder"
rm -rf "$work"
