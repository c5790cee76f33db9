#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks that every pattern of the filters that leave tests out on foreign machines matches a test of this tree: the exclusion
# of the test preset "foreign" (CMakePresets.json) and the list $long of tests/emulated/run.sh. A pattern that matches nothing,
# for example after a test was renamed, would let a long test run under emulation without anybody noticing.
#   tests/cross/filters.sh [TREE]        default: this tree
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

# Prints the names of all tests, one a line: those of GoogleTest and those that CMake adds.
names_of_tests() {
  find tests -name '*.cpp' -exec sed -nE 's/^TEST(_F|_P)?\( *([A-Za-z0-9_]+) *, *([A-Za-z0-9_]+).*/\2.\3/p' {} +
  find tests -name CMakeLists.txt -exec sed -nE 's/.*add_test\(NAME ([A-Za-z0-9_.]+).*/\1/p' {} +
}

names=$(names_of_tests | LC_ALL=C sort -u)
filter=$(sed -nE '/"filter": *\{ *"exclude"/,/\}/ s/^ *"\^\((.*)\)"$/\1/p' CMakePresets.json)
long=$(sed -nE "s/^long='(.*)'$/\1/p" tests/emulated/run.sh)
[[ -n $names && -n $filter && -n $long ]] || {
  echo "filters: found no tests, no exclusion in CMakePresets.json or no list 'long' in tests/emulated/run.sh" >&2
  exit 1
}

# check FILE PATTERN REGEX: counts the pattern, and reports it if its regular expression matches no test.
checked=0 unmatched=0
check() {
  checked=$((checked + 1))
  grep -qE "$3" <<<"$names" || {
    echo "filters: $1: '$2' matches no test" >&2
    unmatched=$((unmatched + 1))
  }
}

IFS='|' read -r -a patterns <<<"${filter//\\\\/\\}"  # JSON writes a backslash as two
for pattern in "${patterns[@]}"; do check CMakePresets.json "$pattern" "^$pattern"; done
IFS=: read -r -a globs <<<"$long"
for glob in "${globs[@]}"; do
  regex=${glob//./\\.}
  check tests/emulated/run.sh "$glob" "^${regex//\*/.*}\$"
done
[[ $unmatched -eq 0 ]] || exit 1
echo "filters: $checked patterns, each matches a test"
