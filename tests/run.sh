#!/usr/bin/env bash
# Installs what the tests need, builds, and runs them. With --all also: the formatting, core/ on its own, the address
# and thread sanitizers, other CPUs by emulation, the fuzz targets, a real kernel in a virtual machine, and the demo. Ends with one
# line that sums up.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=$(nproc)
passed=()
failed=()

die() {
  echo "run.sh: $*" >&2
  exit 1
}

# What has been compiled before is not compiled again.
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]]; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=${XDG_CACHE_HOME:-$HOME/.cache}/stereod/ccache
  export CCACHE_SLOPPINESS=pch_defines,time_macros  # or nothing that has a precompiled header would be kept
fi

# Tests that send LCM messages do so where nobody else listens. Without that they use the machine's network, or skip
# themselves and say why.
network=()

# Runs a suite and remembers how it went; a failure does not keep the others from running. The suites chain their
# steps with &&, because 'set -e' does not count inside 'if'.
suite() {
  local name=$1
  shift
  printf '\n=== %s\n' "$name"
  local begin=$SECONDS
  if "$@"; then
    passed+=("$name")
    printf '=== %s: passed in %d s\n' "$name" $((SECONDS - begin))
  else
    failed+=("$name")
    printf '=== %s: FAILED after %d s\n' "$name" $((SECONDS - begin))
  fi
}

# Configures, builds and tests one preset of CMakePresets.json. Further arguments: a command that runs ctest.
preset() {
  local name=$1
  shift
  cmake --preset "$name" &&
    cmake --build --preset "$name" -j "$jobs" &&
    "$@" "${network[@]}" ctest --preset "$name" -j "$jobs"
}

# The thread sanitizer of g++ 12 does not start where the kernel spreads addresses widely: keep them in place.
tsan_preset() {
  local fixed_addresses=()
  if setarch "$(uname -m)" -R true 2>/dev/null; then fixed_addresses=(setarch "$(uname -m)" -R); fi
  preset tsan "${fixed_addresses[@]}"
}

# Another version of clang-format formats differently, so only the one the tree was formatted with counts.
check_format() {
  local tool candidate
  for candidate in clang-format-14 clang-format; do
    if command -v "$candidate" >/dev/null && "$candidate" --version | grep -q 'version 14\.'; then
      tool=$candidate
      break
    fi
  done
  if [[ -z ${tool:-} ]]; then
    echo "no clang-format 14 here: not checked"
    return 0
  fi
  find core daemon calib tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 "$tool" --dry-run -Werror
}

# With the package of the very programs that were tested.
virtual_machine() {
  cpack --preset release &&
    bash tests/vm/run.sh --bin build/release/bin ${ahead:+--pause "$ahead"} \
      --package build/release/stereod_*_"$(dpkg --print-architecture)".deb
}

# The virtual machine leaves a third of the CPUs' time: meanwhile the other suites are compiled, with that, except where
# a scenario wants it all. A job with a
# process group of its own, in the session that 'nice' weighs it in. What fails here fails again where it belongs.
ahead=
compile_ahead() {
  toolchain/install-deps.sh --emulation || return 0  # not beside another apt
  set -m
  {
    for preset in core asan tsan; do
      cmake --preset "$preset" && nice -n 19 cmake --build --preset "$preset" -j "$jobs"
    done
    for preset in core-arm64 core-armhf core-i386; do
      cmake --preset "$preset" && nice -n 19 cmake --build --preset "$preset" -j "$jobs" --target test_core
    done
  } >build/ahead.log 2>&1 </dev/null &
  ahead=$!
  set +m
}
trap '[[ -z $ahead ]] || kill -- -"$ahead" 2>/dev/null || true' EXIT

# That core/ needs a compiler and GoogleTest alone. Its tests are the same as in the whole, so here they run as on other
# CPUs; what is built is used there.
core_only() {
  cmake --preset core && cmake --build --preset core -j "$jobs"
}

# Says itself which CPUs it has to skip where the emulator or a compiler cannot be had.
emulated_cpus() {
  toolchain/install-deps.sh --emulation && tests/emulated/run.sh
}

fuzz_targets() {
  toolchain/install-deps.sh --emulation && tests/fuzz/run.sh
}

case "${1:-}" in
  '' | --all) ;;
  *) die "usage: tests/run.sh [--all]" ;;
esac

toolchain/install-deps.sh --tests
if toolchain/own-network.sh --possible; then
  network=(toolchain/own-network.sh)
else
  echo "run.sh: no network namespace can be made here; tests that need multicast use this machine's network or skip."
fi

suite tests preset release
if [[ ${1:-} == --all ]]; then
  compile_ahead
  suite virtual-machine virtual_machine
  [[ -z $ahead ]] || wait "$ahead" || true  # two builds of one preset at once would spoil it
  ahead=
  suite format check_format
  suite core-only core_only
  suite address-sanitizer preset asan
  suite thread-sanitizer tsan_preset
  suite emulated-cpus emulated_cpus
  suite fuzz-targets fuzz_targets
  suite demo bash daemon/demo.sh
fi

echo
if [[ ${#failed[@]} -gt 0 ]]; then
  echo "run.sh: ${#passed[@]} suites passed (${passed[*]:-none}), ${#failed[@]} FAILED (${failed[*]})."
  exit 1
fi
echo "run.sh: passed: ${passed[*]}."
