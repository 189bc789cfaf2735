#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes moves.marey for the sample scenes:
#   make_scene_base.sh MAREY          clips of their folder: idle, reach, walk
#   make_scene_base.sh MAREY DATA     also kick, guard, punch, walk_drunk, from recordings
#                                     that are not distributed with marey
# MAREY is the program; DATA holds mocap/bandai, mocap/cmu_asfamc and library/bandai.tar.xz.
set -euo pipefail
if (($# < 1 || $# > 2)); then
  sed -n 's/^# \{0,1\}//; 4,9p' "$0" >&2
  exit 2
fi
marey=$(realpath "$1")
data=${2:+$(realpath "$2")}
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../recordings/samples/scenes"

sources=(clips/idle.bvh moves/shipped)
if [[ -n $data ]]; then
  mkdir -p captures
  cp "$data"/mocap/bandai/dataset-1_kick_normal_001.bvh \
    "$data"/mocap/cmu_asfamc/02.asf "$data"/mocap/cmu_asfamc/02_05.amc captures/
  tar xf "$data"/library/bandai.tar.xz -C captures --strip-components=2 \
    bandai/set1/dataset-1_walk_tired_001.bvh
  sources+=(moves/captured)
fi
"$marey" base build "${sources[@]}" --loops idle --out moves.marey
