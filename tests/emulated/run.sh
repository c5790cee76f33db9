#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs tests of core/ on CPUs that this machine is not: the matcher's on x86 generations, all of them on foreign machines, under
# qemu-user. Each must choose its kernel by itself, and none may meet an instruction that it does not have.
#   tests/emulated/run.sh [NAME...]     only these rows of the table below
# STEREOD_TEST_CASES sets how many random cases each CPU gets.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# name      preset of CMakePresets.json, program that emulates, the kernel to be chosen
table=(
  "conroe     core        qemu-x86_64,-cpu,Conroe,+movbe                  ssse3"
  "penryn     core        qemu-x86_64,-cpu,Penryn                         sse41"
  "denverton  core        qemu-x86_64,-cpu,Denverton                      sse41"
  "haswell    core        qemu-x86_64,-cpu,Haswell                        avx2"
  "n270       core-i386   qemu-i386,-cpu,n270,-L,/usr/i686-linux-gnu,-E,LD_LIBRARY_PATH=/usr/i686-linux-gnu/lib ssse3"
  "arm64      core-arm64  qemu-aarch64,-L,/usr/aarch64-linux-gnu          neon"
  "armhf      core-armhf  qemu-arm,-L,/usr/arm-linux-gnueabihf            neon"
)
# Without some that go over what the others have shown, at length.
long='MatcherFuzzReplay.*:MatcherCorners.ABandMatcherUsedAgain*:SubpixelBias.*:StereoRectification.Zoom*'
matcher="Isa.*:Matcher*:Semiglobal*:-$long"
everything="-$long"
export STEREOD_TEST_CASES=${STEREOD_TEST_CASES:-120}

die() {
  echo "emulated/run.sh: $*" >&2
  exit 1
}

compiler_of() {
  case $1 in
    core) echo g++ ;;
    core-i386) echo i686-linux-gnu-g++ ;;
    core-arm64) echo aarch64-linux-gnu-g++ ;;
    core-armhf) echo arm-linux-gnueabihf-g++ ;;
  esac
}

wanted() {
  local name=$1
  shift
  [[ $# -eq 0 || " $* " == *" $name "* ]]
}

names=$(printf '%s\n' "${table[@]}" | awk '{printf "%s%s", (NR > 1 ? ", " : ""), $1}')
for name in "$@"; do
  [[ ", $names," == *" $name,"* ]] || die "there is no CPU called '$name'; there are $names."
done

declare -A built
passed=()
failed=()
skipped=()
for row in "${table[@]}"; do
  read -r name preset emulator isa <<<"$row"
  wanted "$name" "$@" || continue
  # '-cpu,Conroe,+movbe' is one option with a comma in its value.
  emulator=${emulator/,+/@+}
  IFS=, read -r -a emulate <<<"$emulator"
  emulate=("${emulate[@]/@+/,+}")
  if ! command -v "${emulate[0]}" >/dev/null || ! command -v "$(compiler_of "$preset")" >/dev/null; then
    echo "--- $name: SKIPPED, no ${emulate[0]} or $(compiler_of "$preset") here (toolchain/install-deps.sh --emulation)"
    skipped+=("$name")
    continue
  fi
  if [[ $preset == core-* && ! -d /usr/src/googletest ]]; then
    echo "--- $name: SKIPPED, no /usr/src/googletest here (toolchain/install-deps.sh --emulation)"
    skipped+=("$name")
    continue
  fi
  if [[ -z ${built[$preset]:-} ]]; then
    { cmake --preset "$preset" && cmake --build --preset "$preset" -j "$(nproc)" --target test_core; } >/dev/null ||
      die "preset $preset does not build: cmake --preset $preset && cmake --build --preset $preset"
    built[$preset]=yes
  fi
  tests=$everything
  [[ $preset != core ]] || tests=$matcher
  begin=$SECONDS
  # qemu names every feature of the CPU that it cannot emulate; none of them is an instruction that is used here.
  if STEREOD_EXPECTED_ISA=$isa "${emulate[@]}" "build/$preset/bin/test_core" --gtest_brief=1 \
    --gtest_filter="$tests" 2>&1 | sed "/TCG doesn't support/d"; then
    echo "--- $name (${emulate[*]}): passed with kernel $isa in $((SECONDS - begin)) s"
    passed+=("$name")
  else
    echo "--- $name (${emulate[*]}), kernel $isa expected: FAILED"
    failed+=("$name")
  fi
done

[[ ${#failed[@]} -eq 0 ]] || die "${#passed[@]} CPUs passed (${passed[*]:-none}), ${#failed[@]} FAILED (${failed[*]})."
[[ ${#skipped[@]} -eq 0 ]] || echo "emulated/run.sh: skipped: ${skipped[*]}."
echo "emulated/run.sh: passed: ${passed[*]:-none}."
