#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# runtime_closure.sh PROGRAM [--list]
#
# Prints the installed size of all Debian packages that PROGRAM needs to run, from an empty
# root: the packages of its libraries and their dependencies, without recommendations.
# --list: also each package with its size, largest first. Needs apt's package lists.
set -euo pipefail
export LC_ALL=C

[[ $# -ge 1 ]] || { sed -n 5,10p "$0" >&2; exit 2; }
program=$1

mapfile -t files < <(ldd "$program" | awk '$3 ~ /^\// { print $3 }' | xargs readlink -f)
# Debian 12 lists the files of /lib without /usr, so the query contains both names.
mapfile -t packages < <(dpkg-query -S "${files[@]}" "${files[@]#/usr}" 2>/dev/null |
  sed 's/[:,].*//' | sort -u)
# An empty list of installed packages: apt plans the whole root.
mapfile -t planned < <(apt-get -s -o Dir::State::status=/dev/null -o APT::Get::AllowUnauthenticated=true \
  --no-install-recommends install "${packages[@]}" | awk '$1 == "Inst" { print $2 }' | sort -u)
sizes=$(apt-cache show --no-all-versions "${planned[@]}" |
  awk '$1 == "Package:" { name = $2 } $1 == "Installed-Size:" { print $2, name }' |
  sort -rn -u)
[[ ${2:-} != --list ]] || awk '{ printf "%9.1f MB  %s\n", $1 / 1000, $2 }' <<<"$sizes"
awk '{ sum += $1 } END { printf "%d packages, %.0f MB installed\n", NR, sum / 1000 }' \
  <<<"$sizes"
