#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Two builds of the same commit, in two directories and under other circumstances (time zone, language, umask, user's home), give
# the same packages byte for byte.
#   reproducible.sh [COMMIT [DIRECTORY-OF-DEBS]]
# Builds everything twice, without a compiler cache: some fifteen minutes on two cores. With DIRECTORY-OF-DEBS (packages of
# the commit, made by the preset package in another directory) it builds once.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
commit=$(git rev-parse "${1:-HEAD}")
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct "$commit")
export SOURCE_DATE_EPOCH CCACHE_DISABLE=1

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "reproducible: FAILED: $*" >&2
  exit 1
}

# build DIRECTORY VARIABLE=VALUE…
build() {
  local directory=$1
  shift
  mkdir -p "$directory"
  git archive "$commit" | tar -x -C "$directory"
  (cd "$directory" && env "$@" sh -c 'cmake --preset package && cmake --build --preset package -j "$1" && cpack --preset package' \
    sh "${JOBS:-$(nproc)}") >"$directory.log" 2>&1 || { tail -n 30 "$directory.log" && fail "it does not build in $directory"; }
}

first=${2:-$work/a/build/package}
second=$work/another/directory-with-a-longer-name
mkdir -p "$work/another" "$work/home"
[[ -n ${2:-} ]] || (umask 022 && build "$work/a" TZ=UTC LC_ALL=C)
(umask 077 && build "$second" TZ=Pacific/Kiritimati LC_ALL=C.UTF-8 HOME="$work/home")

count=0
different=()
for package in "$first"/*.deb; do
  count=$((count + 1))
  other=$second/build/package/${package##*/}
  if ! cmp "$package" "$other"; then
    rm -rf "$work/one" "$work/two"
    dpkg-deb -R "$package" "$work/one" && dpkg-deb -R "$other" "$work/two"
    diff -rq "$work/one" "$work/two" || true
    dpkg-deb -c "$package" >"$work/one.list" && dpkg-deb -c "$other" >"$work/two.list"
    diff "$work/one.list" "$work/two.list" || true
    different+=("${package##*/}")
    continue
  fi
  echo "reproducible: ${package##*/}: $(sha256sum <"$package" | cut -c -16)…, twice the same"
done
[[ ${#different[@]} -eq 0 ]] || fail "not the same twice, of ${commit:0:7}: ${different[*]}"
[[ $count -ge 2 ]] || fail "only $count packages were made"
