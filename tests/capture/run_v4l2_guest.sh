#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# run_v4l2_guest.sh PROGRAM KERNEL WORK: runs the static PROGRAM (v4l2_guest.cpp) in an
# emulated machine whose kernel simulates cameras, and prints its output. KERNEL is a folder
# of fetch_guest_kernel.sh, which is called when it is empty; WORK is scratch. Prints
# "skipped:" when the emulator or the kernel is missing.
set -euo pipefail

readonly program=$1 kernel=$2 work=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
export PATH=$PATH:/usr/sbin:/sbin

skip() {
  echo "skipped: $*"
  exit 0
}

for tool in qemu-system-x86_64:qemu-system-x86 cpio:cpio; do
  command -v "${tool%:*}" >/dev/null || skip "${tool%:*} is missing; apt-get install ${tool#*:}"
done
busybox=$(command -v busybox) || skip "busybox is missing; apt-get install busybox-static"
! ldd "$busybox" &>/dev/null ||
  skip "busybox needs libraries; apt-get install busybox-static"
if [[ ! -e $kernel/modules/order ]]; then
  command -v modprobe >/dev/null || skip "modprobe is missing; apt-get install kmod"
  "$here/fetch_guest_kernel.sh" "$kernel" ||
    skip "the kernel cannot be fetched; ./run setup tests"
fi

rm -rf "$work"
mkdir -p "$work/tree"/{bin,dev,proc,sys}
cp "$busybox" "$work/tree/bin/busybox"
cp "$program" "$work/tree/guest"
cp "$kernel"/modules/* "$here"/data/mjpg_*.jpg "$work/tree/"
cat >"$work/tree/init" <<'INIT'
#!/bin/busybox sh
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
while read module; do
  case $module in
    # Two cameras, and an output next to the second.
    vivid.ko) insmod /$module n_devs=2 node_types=0x1,0x101 ;;
    v4l2loopback.ko) insmod /$module video_nr=3 exclusive_caps=0 ;;
    *) insmod /$module ;;
  esac
done </order
chmod 600 /dev/video*
/guest
echo "GUEST_RC=$?"
poweroff -f
INIT
chmod +x "$work/tree/init"
(cd "$work/tree" && find . | cpio -o -H newc --quiet | gzip -1) >"$work/initrd"

# icount: the guest's clock counts its instructions and not the host's time, so that a busy
# host cannot make a camera drop frames; sleep=off: waiting takes no time.
timeout 240 qemu-system-x86_64 -accel tcg -cpu max -smp 1 -m 256 -icount shift=1,sleep=off \
  -rtc clock=vm -display none -serial "file:$work/log" -monitor none -no-reboot -nic none \
  -kernel "$kernel/vmlinuz" -initrd "$work/initrd" -append "console=ttyS0 panic=-1 quiet" ||
  echo "the machine ended with $?"
tr -d '\r' <"$work/log" | grep -a -v '^$' || true
grep -aq 'GUEST_RC=0' "$work/log"
