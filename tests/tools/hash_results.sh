#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# hash_results.sh PROGRAM DATA OUT [TAKE]
#
# Runs PROGRAM over the sample session, the rendered session, one fit, one adaptation and
# one retargeting (DATA: the folder of recordings with truth), and prints the SHA-256 of
# each numeric result, one line per file. Two programs that print the same lines compute
# the same results. Reports and their JSON are left out: they hold durations and wording.
# TAKE: a recorded live run, which is replayed; a replay that differs fails.
set -euo pipefail

[[ $# -ge 3 ]] || { sed -n 5,12p "$0" >&2; exit 2; }
program=$(readlink -f "$1")
data=$(readlink -f "$2")
out=$3
take=${4:-}
here=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
mkdir -p "$out"

# A verdict of the quality of results is no failure here.
run() {
  local code=0
  "$program" --progress none "$@" >>"$out/log.txt" 2>&1 || code=$?
  [[ $code -eq 0 || $code -eq 3 || $code -eq 4 ]] || {
    printf 'error: exit code %d of: %s. Next: see %s\n' "$code" "$*" "$out/log.txt" >&2
    exit 1
  }
}

standing=$data/mocap/c3d_org_samples/sample_26/Standing_Hybrid_2.c3d
walking=$data/mocap/c3d_org_samples/sample_26/Walking_Hybrid_2.c3d
walk=$data/mocap/bandai/dataset-1_walk_normal_001.bvh
run demo --out "$out/sample"
run process "$here/recordings/samples/blender-dev/session.toml" --media "$data/blender/dev" \
  --out "$out/rendered"
run retarget "$walk" "$data/avatars/vrm/cryptovoxels.vrm" \
  --formats glb,bvh,vrma,npz,csv --out "$out/retarget" --constraints-out "$out/feet.xml"
run adapt "$walk" --constraints "$out/feet.xml" --balance horizontal --out "$out/adapted.bvh"
run fit "$standing" "$walking" --out "$out/fit"
if [[ -n $take ]]; then
  run replay "$take" --fast
fi

cd "$out"
find . -type f \( -name '*.csv' -o -name '*.toml' -o -name '*.glb' -o -name '*.bvh' \
  -o -name '*.vrma' -o -name '*.npz' -o -name '*.c3d' -o -name '*.trc' -o -name '*.mot' \
  -o -name '*.xml' \) | LC_ALL=C sort | while read -r file; do
  # Detections name the video's path.
  printf '%s  %s\n' "$(sed '/^# source:/d' "$file" | sha256sum | cut -d' ' -f1)" "$file"
done
