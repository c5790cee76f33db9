#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds and runs suites of tests, and installs what they need.
#   tests/run.sh                       the minimum for every change: formatting and the release build's tests
#   tests/run.sh SUITE [ARGUMENT…]…    the suites named, for example: tests/run.sh asan, tests/run.sh vm replug, tests/run.sh tests -R Config
#   tests/run.sh --all                 everything that must hold before a change is accepted (.ci/run)
#   tests/run.sh --extended            what --all leaves out: other architectures, bare machines, reproducibility; keeps
#                                      a table of what ran on which commit, with what result, in build/extended.md
#   tests/run.sh --list                the suites
# The last line counts single tests: N passed, N failed, N skipped. The exit status is 0 if none failed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

jobs=${JOBS:-$(nproc)}

# name          takes arguments   what it is
suites=(
  "format        no   sources are formatted by clang-format 14"
  "tests         yes  release build, all its tests; arguments go to ctest"
  "tidy          yes  clang-tidy 14 on core/, daemon/ and calib/; arguments: files"
  "vm            yes  a real kernel with webcams in a virtual machine; arguments: scenarios of tests/vm/scenarios"
  "core-only     no   core/ builds with a compiler and GoogleTest alone"
  "asan          yes  AddressSanitizer and UndefinedBehaviorSanitizer; arguments go to ctest"
  "tsan          yes  ThreadSanitizer on what runs in several threads; arguments go to ctest"
  "emulated      yes  core/ on other CPUs, by emulation; arguments: CPUs of tests/emulated/run.sh"
  "fuzz          yes  libFuzzer on matcher, camera frames and client; argument: seconds for each"
  "demo          no   daemon/demo.sh"
  "cross         yes  everything for arm64, armhf and i386, with packages; arguments: architectures"
  "roots         no   packages installed, upgraded and removed in bare Debian roots"
  "bare-board    no   docs/from-bare-board.md, word for word, on a bare machine"
  "deploy        no   toolchain/deploy.sh against a second machine"
  "reproducible  no   two builds of the commit give the same packages"
)
default_suites=(format tests)
all_suites=(format tests vm core-only tidy asan tsan emulated fuzz demo)
extended_suites=(cross roots bare-board deploy reproducible)

die() {
  echo "run.sh: $*" >&2
  exit 1
}

# suite_field NAME FIELD: 1 the name, 2 whether it takes arguments; empty for no suite.
suite_field() { printf '%s\n' "${suites[@]}" | awk -v name="$1" -v field="$2" '$1 == name { print $field }'; }

# --- the command line: the suites in the order they run, and the arguments of each
selected=()
declare -A arguments=()
extended=
case "${1:-}" in
  '') selected=("${default_suites[@]}") ;;
  --all) selected=("${all_suites[@]}") ;;
  --extended) selected=("${extended_suites[@]}") extended=yes ;;
  --list | --help | -h)
    sed -n '3,/^set/{/^set/d; s/^# \{0,1\}//; p}' tests/run.sh
    printf '%s\n' "${suites[@]}" | sed -E 's/^([^ ]+ +)(no |yes) +/  \1/'
    exit 0
    ;;
  -*) die "unknown option '$1'; see tests/run.sh --list" ;;
  *)
    for word in "$@"; do
      if [[ -n $(suite_field "$word" 1) ]]; then
        selected+=("$word")
      elif [[ ${#selected[@]} -gt 0 && $(suite_field "${selected[-1]}" 2) == yes ]]; then
        arguments[${selected[-1]}]+="${arguments[${selected[-1]}]:+ }$word"
      else
        die "there is no suite '$word'; tests/run.sh --list names them."
      fi
    done
    ;;
esac
[[ ${1:-} != --all && ${1:-} != --extended || $# -eq 1 ]] || die "$1 takes no arguments."
runs() { [[ " ${selected[*]} " == *" $1 "* ]]; }

# --- how a suite runs
logs=build/run
mkdir -p "$logs"
passed=0 failed=0 skipped=0  # single tests
results=()                   # of suites, "name result seconds"
bad=()                       # the suites that failed

# Adds to the counts of the suite that runs: passed, failed, skipped.
count() { suite_counts=$((suite_counts + 1)) && passed=$((passed + $1)) && failed=$((failed + $2)) && skipped=$((skipped + $3)); }

# Runs a suite and remembers how it went; a failure does not keep the others from running. The suites chain their steps
# with &&, because 'set -e' has no effect inside 'if'. A suite that counts no tests is itself one.
suite() {
  local name=$1 begin=$SECONDS result status=0 failed_before=$failed
  shift
  suite_counts=0
  printf '\n=== %s\n' "$name"
  if "$@"; then
    result=passed
  else
    status=$?
    result=FAILED
    [[ $status -ne 77 ]] || result=skipped
  fi
  case $result in
    passed) [[ $suite_counts -gt 0 ]] || count 1 0 0 ;;
    skipped) count 0 0 1 ;;
    FAILED)
      bad+=("$name")
      [[ $failed -gt $failed_before ]] || count 0 1 0
      ;;
  esac
  results+=("$name $result $((SECONDS - begin))")
  printf '=== %s: %s after %d s\n' "$name" "$result" $((SECONDS - begin))
}

# Compiled objects are shared by all builds, also of other directories.
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]]; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=${XDG_CACHE_HOME:-$HOME/.cache}/stereod/ccache
  export CCACHE_SLOPPINESS=pch_defines,time_macros  # without it nothing that has a precompiled header is kept
  export CCACHE_BASEDIR=$PWD
fi

# Tests that send LCM messages do so in a network of their own. Without one they use the machine's network, or skip
# themselves and say why.
network=()

# Runs ctest on a preset and counts single tests.
#   run_ctest SUITE PRESET [COMMAND…]      COMMAND: a program that runs ctest
run_ctest() {
  local suite=$1 name=$2 log=$logs/$2 status=0 p f s
  shift 2
  rm -f "$log.xml"
  # shellcheck disable=SC2086  # arguments are words
  "$@" "${network[@]}" ctest --preset "$name" -j "$jobs" --output-junit "$PWD/$log.xml" --output-log "$log.log" \
    --test-output-size-passed 10000000 --test-output-size-failed 10000000 ${arguments[$suite]:-} || status=$?
  [[ -s $log.xml ]] || return 1
  read -r p f s < <(tests/count_tests.sh "$log.xml")
  [[ $((p + f)) -gt 0 ]] || { echo "no test ran ${arguments[$suite]:-}" && return 1; }
  count "$p" "$f" "$s"
  return "$status"
}

# build PRESET [OPTION…]: configures and builds a preset of CMakePresets.json; options go to the build.
build() {
  local name=$1
  shift
  cmake --preset "$name" >"$logs/$name-configure.log" && cmake --build --preset "$name" -j "$jobs" "$@"
}

# --- the suites
run_tests() {
  build release || return 1
  compile_ahead  # tests wait a quarter of their time
  run_ctest tests release
}

run_asan() { build asan && run_ctest asan asan; }

# The thread sanitizer of g++ 12 does not start where the kernel spreads addresses widely: keeps them in place.
run_tsan() {
  local fixed_addresses=()
  if setarch "$(uname -m)" -R true 2>/dev/null; then fixed_addresses=(setarch "$(uname -m)" -R); fi
  build tsan && run_ctest tsan tsan "${fixed_addresses[@]}"
}

# Other versions of clang-format format differently.
run_format() {
  local tool
  tool=$(command -v clang-format-14 || command -v clang-format) || tool=
  if [[ -z $tool ]] || ! "$tool" --version | grep -q 'version 14\.'; then
    echo "no clang-format 14 here: toolchain/install-deps.sh --tests installs it."
    return 1
  fi
  find core daemon calib tests \( -name '*.h' -o -name '*.cpp' \) -print0 | xargs -0 -P "$jobs" -n 40 "$tool" --dry-run -Werror
}

# With a package of the very programs that run in the machine, if a scenario wants it.
run_vm() {
  local log=$logs/vm.log status=0 name needs= package=()
  for name in ${arguments[vm]:-tests/vm/scenarios/*.sh}; do
    name=tests/vm/scenarios/$(basename "$name" .sh).sh
    ! grep -qs '^# needs: package' "$name" || needs=packaged
  done
  build release --target vm_programs $needs || return 1
  if [[ -n $needs ]]; then
    cpack --preset release >"$logs/cpack.log" || return 1
    package=(--package "$(ls build/release/stereod_*_"$(dpkg --print-architecture)".deb)")
  fi
  compile_ahead  # the machine leaves a third of the CPUs' time
  # shellcheck disable=SC2086
  bash tests/vm/run.sh --bin build/release/bin ${ahead:+--pause "$ahead"} "${package[@]}" ${arguments[vm]:-} 2>&1 |
    tee "$log" || status=$?
  count_lines "$log" '^vm/run: [^ ]+ +passed in' '^vm/run: [^ ]+ +FAILED;'
  return "$status"
}

# count_lines LOG PASSED FAILED: counts tests by the lines that say so, and what a line "SKIPPED: a b" names.
count_lines() {
  local names
  names=$(sed -nE 's/^[a-z/.]+: (SKIPPED|skipped): ([^(.]*).*/\2/p' "$1" | wc -w)
  count "$(grep -cE "$2" "$1" || true)" "$(grep -cE "$3" "$1" || true)" "$names"
}

# That core/ needs a compiler and GoogleTest alone. Its tests are those of the whole, which run in the suites tests and
# emulated.
run_core_only() {
  build core
}

run_emulated() {
  local log=$logs/emulated.log status=0
  toolchain/install-deps.sh --emulation || return 1
  # shellcheck disable=SC2086
  tests/emulated/run.sh ${arguments[emulated]:-} 2>&1 | tee "$log" || status=$?
  count_lines "$log" '^--- .*: passed with' '^--- .*: FAILED'
  return "$status"
}

run_fuzz() {
  local log=$logs/fuzz.log status=0
  toolchain/install-deps.sh --emulation || return 1
  # shellcheck disable=SC2086
  tests/fuzz/run.sh ${arguments[fuzz]:-} 2>&1 | tee "$log" || status=$?
  count_lines "$log" '^fuzz/run.sh: [a-z_]+: Done' '^fuzz/run.sh: .* FAILED'
  return "$status"
}

# shellcheck disable=SC2086
run_suite() {
  case $1 in
    format) run_format ;;
    tests) run_tests ;;
    tidy) tests/tidy/run.sh ${arguments[tidy]:-} ;;
    vm) run_vm ;;
    core-only) run_core_only ;;
    asan) run_asan ;;
    tsan) run_tsan ;;
    emulated) run_emulated ;;
    fuzz) run_fuzz ;;
    demo) bash daemon/demo.sh ;;
    cross) tests/cross/run.sh ${arguments[cross]:-} ;;
    roots) tests/package/roots.sh ;;
    bare-board) tests/package/bare_board.sh ;;
    deploy) tests/package/deploy.sh ;;
    reproducible) tests/package/reproducible.sh ;;
  esac
}

# Compiles what later suites need, in the background and below everything else's priority. Its own process group, so that
# a scenario of the virtual machine that wants the CPUs for itself can stop it. What fails here fails again where it belongs.
ahead=
compile_ahead() {
  local later
  later=$(comm -12 <(printf '%s\n' asan core-only emulated fuzz tidy tsan) <(printf '%s\n' "${selected[@]}" | sort -u))
  [[ -z $ahead && -n $later ]] || return 0
  if runs emulated || runs fuzz; then toolchain/install-deps.sh --emulation || return 0; fi  # not beside another apt
  set -m
  {
    renice -n 19 -p "$BASHPID" >/dev/null
    ! runs asan || build asan
    ! runs tsan || build tsan
    ! runs core-only && ! runs emulated || build core
    if runs emulated; then
      for name in core-arm64 core-armhf core-i386; do build "$name" --target test_core; done
    fi
    ! runs fuzz || tests/fuzz/run.sh --build
    ! runs tidy || tests/tidy/run.sh
  } >"$logs/ahead.log" 2>&1 </dev/null &
  ahead=$!
  set +m
}
# Two builds of one preset at once would spoil it.
wait_for_ahead() {
  [[ -z $ahead ]] || wait "$ahead" || true
  ahead=
}
trap '[[ -z $ahead ]] || kill -- -"$ahead" 2>/dev/null || true' EXIT

# --- the run
echo "run.sh: will run: ${selected[*]}"
for name in "${selected[@]}"; do
  printf '  %-13s %s\n' "$name" "$(printf '%s\n' "${suites[@]}" | sed -nE "s/^$name +(no|yes) +//p")${arguments[$name]:+ [${arguments[$name]}]}"
done
toolchain/install-deps.sh --tests
[[ -z $extended ]] && ! runs cross || toolchain/install-deps.sh --packages
if toolchain/own-network.sh --possible; then
  network=(toolchain/own-network.sh)
else
  echo "run.sh: no network namespace can be made here; tests that need multicast use this machine's network or skip."
fi
begun=$(date -u '+%Y-%m-%d %H:%M')
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
[[ -z $(git status --porcelain 2>/dev/null) ]] || commit+=" (changed)"

for name in "${selected[@]}"; do
  case $name in tests | vm | format) ;; *) wait_for_ahead ;; esac
  suite "$name" run_suite "$name"
done

# The table of the suites outside --all: a suite that ran has a new row, the others keep theirs.
table=build/extended.md
for result in "${results[@]}"; do
  read -r name outcome seconds <<<"$result"
  [[ " ${extended_suites[*]} " == *" $name "* ]] || continue
  touch "$table"
  rows=$(grep -vE "^\| ($name|suite) |^\|---" "$table" || true)
  {
    printf '| suite | commit | begun (UTC) | result | seconds |\n|---|---|---|---|---|\n'
    { [[ -z $rows ]] || echo "$rows"; printf '| %s | %s | %s | %s | %s |\n' "$name" "$commit" "$begun" "$outcome" "$seconds"; } | sort
  } >"$table.new"
  mv "$table.new" "$table"
done
[[ -z $extended ]] || { echo && cat "$table"; }

echo
for result in "${results[@]}"; do
  read -r name outcome seconds <<<"$result"
  printf 'run.sh: %-13s %-8s %5d s\n' "$name" "$outcome" "$seconds"
done
[[ ${#bad[@]} -eq 0 ]] || echo "run.sh: FAILED: ${bad[*]}"
echo "$passed passed, $failed failed, $skipped skipped"
[[ ${#bad[@]} -eq 0 ]]
