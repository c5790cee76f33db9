#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs clang-tidy 14 with the checks of .clang-tidy on core/, daemon/ and calib/; fails on what it finds, and where it is
# missing.
#   tests/tidy/run.sh [FILE…]        FILE: only these, one by one
#
# A run parses each library as one unit (a unity build), because headers take most of the time. Sources whose anonymous names
# clash are parted into smaller units. What passed is remembered by the hash of the preprocessed unit, the checks and the tool
# in ~/.cache/stereod/tidy, so that an unchanged unit costs a preprocessor run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

tool=clang-tidy-14
build=build/tidy
cache=${XDG_CACHE_HOME:-$HOME/.cache}/stereod/tidy
# In a unit, sources are included (a check of its own), and warnings about names that another source has are no findings:
# g++ warns of each source by itself.
unit_options=(--checks=-bugprone-suspicious-include '--header-filter=(core|daemon|calib)/.*\.(h|cpp)$')

# --- one unit, called by xargs: its file and its command
flags=()
status=0

# check FILE [FLAG…]: runs the tool, unless this very text has passed before.
check() {
  local file=$1 hash
  shift
  # Comments are part of the text: NOLINT is one.
  hash=$({ "$tool" --version && cat .clang-tidy && printf '%s\n' "${unit_options[@]}" "${flags[@]}" "$@" &&
    g++ "${flags[@]}" -E -P -C -dD "$file"; } | sed "s#$PWD#.#g" | sha256sum | cut -c -40)
  if [[ -e $cache/$hash ]]; then
    touch "$cache/$hash"
  elif "$tool" --quiet --config-file=.clang-tidy "${unit_options[@]}" "$file" -- "${flags[@]}" -Wno-unknown-warning-option "$@" \
    >"$work/log" 2>&1; then
    touch "$cache/$hash"
  else
    status=1
    grep -vE 'warnings? (and [0-9]+ errors? )?generated\.$|^Suppressed |^Use -header-filter|^[0-9]+ warnings? treated' "$work/log" || true
  fi
}

# check_together SOURCE…: as one unit if they compile as one, else in halves.
check_together() {
  if [[ $# -eq 1 ]]; then
    check "$1"
    return
  fi
  local unit half=$(($# / 2))
  unit=$work/$(printf '%s\n' "$@" | sha256sum | cut -c -16).cpp
  printf '#include "%s"\n' "$@" >"$unit"
  if g++ "${flags[@]}" -w -fsyntax-only "$unit" 2>/dev/null; then
    check "$unit" -w
  else
    check_together "${@:1:half}"
    check_together "${@:half+1}"
  fi
}

if [[ ${1:-} == --unit ]]; then
  file=$2
  mapfile -t words < <(xargs -n 1 <<<"$3")
  for ((i = 1; i < ${#words[@]}; ++i)); do
    case ${words[i]} in
      -o) i=$((i + 1)) ;;
      -c | "$file" | */c++ | */g++) ;;
      -fvect-cost-model=* | -mmemset-strategy=*) ;;  # only g++ knows them
      *) flags+=("${words[i]}") ;;
    esac
  done
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  if [[ $file == */Unity/* ]]; then
    mapfile -t sources < <(sed -n 's/^#include "\(.*\)"$/\1/p' "$file")
  else
    sources=("$file")
  fi
  check_together "${sources[@]}"
  exit "$status"
fi

command -v "$tool" >/dev/null || {
  echo "tidy: $tool is missing: toolchain/install-deps.sh --tests installs it." >&2
  exit 1
}
cmake --preset tidy >/dev/null && cmake --build "$build" --target stereod_lcmtypes_generate >/dev/null
if [[ $# -gt 0 ]]; then
  exec "$tool" -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option "$@"
fi
included=$(grep -rnE '#include ".*\.cpp"' core daemon calib || true)
[[ -z $included ]] || { echo "tidy: sources are not included: $included" >&2 && exit 1; }

mkdir -p "$cache"
find "$cache" -type f -mtime +30 -delete
begin=$SECONDS
# CMake writes one key a line. The longest units first.
awk '
  function value(line) { sub(/^ *"[a-z]+": "/, "", line); sub(/",?$/, "", line); gsub(/\\"/, "\"", line); gsub(/\\\\/, "\\", line); return line }
  /^ *"command":/ { command = value($0); sub(/^[^ ]*ccache /, "", command) }
  /^ *"file":/ { file = value($0); print file "\t" command }' "$build/compile_commands.json" >"$build/units"
failed=0
while IFS=$'\t' read -r file command; do
  size=$(sed -n 's/^#include "\(.*\)"$/\1/p' "$file" | grep -c '\.cpp$' || true)
  printf '%s\t%s\t%s\n' "$size" "$file" "$command"
done <"$build/units" | sort -rn | cut -f 2- | tr '\t' '\n' | tr '\n' '\0' |
  xargs -0 -n 2 -P "${JOBS:-$(nproc)}" bash "$0" --unit || failed=1
[[ $failed -eq 0 ]] || { echo "tidy: FAILED" && exit 1; }
echo "tidy: $(wc -l <"$build/units") units without findings, in $((SECONDS - begin)) s"
