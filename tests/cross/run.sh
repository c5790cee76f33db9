#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Everything for other architectures: builds it against Debian's libraries of that architecture, runs its tests under
# qemu-user, makes the packages, and compares what they depend on with the ones made for this machine.
#   tests/cross/run.sh [ARCH...]        arm64, armhf, i386; default: all
# Takes up to half an hour for each architecture on two cores (suite "cross" of tests/run.sh). At the end it prints the table
# of docs/boards.md. JOBS sets the number of parallel jobs. Installs the compilers and emulators it needs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
jobs=${JOBS:-$(nproc)}
logs=build/cross

die() {
  echo "cross/run.sh: $*" >&2
  exit 1
}

# step NAME COMMAND…: its output goes to a log; on failure its end is shown.
step() {
  local name=$1 log=$logs/$arch-$1.log begin=$SECONDS
  shift
  if "$@" >"$log" 2>&1; then
    echo "--- $arch: $name done in $((SECONDS - begin)) s"
  else
    echo "--- $arch: $name FAILED; the end of $log:"
    tail -n 30 "$log"
    return 1
  fi
}

# Tests send their LCM messages in a network of their own where one can be made. An emulated CPU that shares the machine with
# another test can be too slow for a test's deadline: failed tests run once more, alone, and are named.
run_tests() {
  local network=()
  if toolchain/own-network.sh --possible; then network=(toolchain/own-network.sh); fi
  "${network[@]}" ctest --preset "$arch" -j "$jobs" --timeout 900 ||
    { echo "=== once more, alone" && "${network[@]}" ctest --preset "$arch" -j 1 --timeout 900 --rerun-failed; }
}

only_package() { ls build/"$1"/"$2"_*.deb; }
make_native() {
  cmake --preset package && cmake --build --preset package -j "$jobs" && rm -f build/package/*.deb && cpack --preset package
}
same_dependencies() {
  local name
  for name in stereod libstereod-dev; do
    tests/package/depends.sh "$(only_package package $name)" "$(only_package "$arch" $name)" || return 1
  done
}

# The kernel that the emulated CPU got: the one that is expected of it, if the test of that has passed and was not skipped.
kernel_chosen() {
  local expected
  expected=$(sed -n 's/^set(STEREOD_EXPECTED_ISA \([a-z0-9]*\)).*/\1/p' "toolchain/$arch.cmake")
  if grep -qE 'Isa\.Auto_IsExpectedForCpu \.* +Passed' "$logs/$arch-tests.log"; then
    echo "$expected"
  else
    echo "not $expected"
  fi
}
# names_of OUTCOME: the tests that ended so, each once.
names_of() { sed -nE "s/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: ([^ ]+) .*$1 .*/\1/p" "$logs/$arch-tests.log" | sort -u; }
# The daemon as it is installed, stripped; on this machine Package.Footprint holds it to the same.
installed_size() { dpkg-deb --fsys-tarfile "$(only_package "$arch" stereod)" | tar -xO ./usr/bin/stereod | wc -c; }
small_enough() {
  local allowed
  allowed=$(sed -n 's/^max_binary=\([0-9]*\).*/\1/p' tests/package/footprint.sh)
  echo "stereod: $(installed_size) bytes; allowed are $allowed"
  [[ $(installed_size) -le $allowed ]]
}
# That the bill of materials accounts for every package that the package depends on, by its name or by one it provides.
whole_bill() {
  local deb library
  deb=$(only_package "$arch" stereod)
  dpkg-deb --fsys-tarfile "$deb" | tar -xO ./usr/share/doc/stereod/bill-of-materials.spdx >"$logs/$arch-bill.spdx" || return 1
  for library in $(dpkg-deb -f "$deb" Depends | tr ',' '\n' | sed -nE 's/^ *(lib[^ ]+).*/\1/p'); do
    awk -v name="$library" '
      $1 == "PackageName:" && $2 == name { found = 1 }
      /^PackageComment: .*; provides / {
        sub(/.*; provides /, "")
        sub(/<\/text>$/, "")
        count = split($0, provided, /, */)
        for (i = 1; i <= count; ++i) { sub(/ .*/, "", provided[i]); if (provided[i] == name) found = 1 }
      }
      END { exit !found }' "$logs/$arch-bill.spdx" || { echo "the bill of materials lacks $library" && return 1; }
  done
}
kib() { echo $((($(stat -c %s "$1") + 1023) / 1024)); }

# One architecture; leaves its line of the table in $line.
one() {
  local status=0 passed=no kernel skipped
  line="| $arch | no | | | | |"
  rm -f build/"$arch"/*.deb
  step sysroot toolchain/make-sysroot.sh "$arch" || return 1
  step configure cmake --preset "$arch" || return 1
  step build cmake --build --preset "$arch" -j "$jobs" || return 1
  step tests run_tests || status=1
  passed=$(names_of 'Passed' | wc -l)
  skipped=$(names_of '\*\*\*Skipped' | wc -l)
  names_of '\*\*\*Skipped' | sed "s/^/    skipped: /"
  sed -n '/^=== once more/,$p' "$logs/$arch-tests.log" | grep -oE 'Test +#[0-9]+: [^ ]+ .*Passed' |
    sed -E 's/Test +#[0-9]+: ([^ ]+) .*/    passed only when run alone: \1/' || true
  kernel=$(kernel_chosen)
  [[ $kernel != not* ]] || status=1
  line="| $arch | yes | $passed passed, $(comm -23 <(names_of '\*\*\*[^S].*') <(names_of Passed) | wc -l) failed, $skipped skipped | | $kernel |"
  step packages cpack --preset "$arch" || return 1
  line="${line/| | $kernel/| $(kib "$(only_package "$arch" stereod)") KiB | $(installed_size) B | $kernel}"
  step size small_enough || status=1
  step dependencies same_dependencies || status=1
  step bill whole_bill || status=1
  return "$status"
}

[[ $# -gt 0 ]] || set -- arm64 armhf i386
tests/cross/filters.sh || die "the filters of the foreign presets name tests that do not exist."
toolchain/install-deps.sh --packages
mkdir -p "$logs"
arch=package
step packages make_native || die "the packages for this machine, to compare with, could not be made."
table=("| amd64 | yes | tests/run.sh | $(kib "$(only_package package stereod)") KiB | $(installed_size) B | by the CPU |")
failed=()
for arch in "$@"; do
  [[ -f toolchain/$arch.cmake ]] || die "there is no architecture '$arch'; there are arm64, armhf and i386."
  one || failed+=("$arch")
  table+=("$line")
done
printf '\n| architecture | builds | tests under emulation | stereod .deb | stripped `stereod` | kernel chosen |\n|---|---|---|---|---|---|\n'
printf '%s\n' "${table[@]}"
[[ ${#failed[@]} -eq 0 ]] || die "FAILED: ${failed[*]}."
echo "cross/run.sh: passed: $*."
