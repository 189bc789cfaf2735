#!/usr/bin/env bash
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# check_path_lengths.sh [FIRST [LAST [SOURCE...]]]
#
# Warnings of g++ about text depend on the lengths of paths that it knows. Puts the commit
# HEAD into folders whose absolute paths have FIRST (5) to LAST (40) characters, such as
# /aaaa, and compiles there with warnings as errors, in Release: every source with a path
# of the checkout in its definitions, and SOURCE (below: tests that use such paths). Prints
# a line per length. Fails if one fails, or if a source has a path in its definitions and
# is not in PATHS. Run it as root: the folders are at the top of the file system.
# Some 20 s of CPU per length; neither precompiled headers nor a compiler cache are used.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."

readonly FIRST=${1:-5} LAST=${2:-40}
readonly PATHS=(app/shell/sample_session.cpp tests/support/program/paths.cpp)
sources=("${@:3}")
[[ ${#sources[@]} -gt 0 ]] ||
  sources=(tests/capture/feeds/decode_frame_test.cpp tests/app/shell/next_step_test.cpp)

fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# compile_commands.json of the checkout $1, a line per source: the source, and its command.
commands_of() {
  awk -v top="$1/" '
    /^  "command": / { command = $0; sub("^ *\"command\": \"", "", command)
                       sub("\",$", "", command); gsub(/\\\\/, "\\", command)
                       gsub(/\\"/, "\"", command) }
    /^  "file": / { file = $2; gsub("[\",]", "", file); sub("^" top, "", file)
                    print file "\t" command }' "$1/build/compile_commands.json"
}

# The sources with a path of the checkout $1 in their definitions.
sources_with_paths() {
  commands_of "$1" | awk -F '\t' -v top="$1/" '
    { count = split($2, words, " ")
      for (i = 1; i <= count; ++i) {
        if (words[i] ~ /^-D/ && index(words[i], top)) { print $1; next } } }' | sort -u
}

# Compiles the source $2 of the checkout $1.
compile() {
  local command
  command=$(commands_of "$1" | awk -F '\t' -v source="$2" '$1 == source { print $2; exit }')
  [[ -n $command ]] || fail "$2 is not compiled"
  (cd "$1/build" && mkdir -p "$(dirname "$(sed 's/.* -o \([^ ]*\).*/\1/' <<<"$command")")" &&
    bash -c "$command")
}

# A launcher that does nothing stands for a compiler cache: there are no precompiled
# headers then, with which some warnings are off.
configure() {
  cmake -S "$1" -B "$1/build" -G Ninja -D CMAKE_BUILD_TYPE=Release -D MAREY_WERROR=ON \
    -D MAREY_VIEWER=OFF -D CMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -D CMAKE_CXX_COMPILER_LAUNCHER=/usr/bin/env
}

check_length() {
  local length=$1 top name found source
  name=$(printf '%*s' $((length - 1)) '' | tr ' ' a)
  top=/$name
  [[ ! -e $top ]] || fail "$top exists. Next: move it away"
  mkdir "$top"
  trap 'rm -rf "$top"' RETURN
  git archive HEAD | tar -x -C "$top"
  configure "$top" >"$top/log" 2>&1 || { tail -20 "$top/log"; return 1; }
  found=$(sources_with_paths "$top")
  [[ $found == "$(printf '%s\n' "${PATHS[@]}")" ]] ||
    fail "other sources have paths in their definitions: ${found//$'\n'/ }"
  for source in "${PATHS[@]}" "${sources[@]}"; do
    compile "$top" "$source" >"$top/log" 2>&1 || { tail -40 "$top/log"; return 1; }
  done
}

failed=0
for ((length = FIRST; length <= LAST; ++length)); do
  if check_length "$length"; then
    printf '%d: ok\n' "$length"
  else
    printf '%d: failed\n' "$length"
    failed=1
  fi
done
exit "$failed"
