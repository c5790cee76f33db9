#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Counts what the matcher costs where a clock would wander: instructions and first-level cache misses for every
# instruction set, and the cycles that llvm-mca's models of small boards' CPUs give for the instructions executed.
# Prints tables. What is counted is the difference of a run that matches three times and one that matches once.
#   tests/bench/counts/counts.sh [--quick]      --quick: only the first case
#
# How the cycles are computed, for every kernel:
#   (1) qemu-user with the plugin count_blocks tells how often each block of instructions is executed in a frame;
#   (2) blocks that follow one another and are executed equally often are one;
#   (3) the hottest, until they make up 97 % of the instructions, are disassembled from the program, and llvm-mca says
#       how many cycles each takes when it repeats; data is taken to be in the first-level cache;
#   (4) cycles times executions, summed, and scaled from the share covered to the whole.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

# name            width height disparities window matcher subpixel; matcher as matcher_once has it
cases=(
  "640x480x64,11x11,xsobel,whole     640 480 64 11 xsobel 0"
  "640x480x64,11x11,xsobel,1/16px    640 480 64 11 xsobel 1"
  "320x240x48,9x9,xsobel,whole       320 240 48 9 xsobel 0"
  "640x480x64,semi-global,coarse     640 480 64 11 coarse 1"
  "640x480x64,semi-global,fine       640 480 64 11 fine 1"
  "320x240x48,semi-global,coarse     320 240 48 9 coarse 1"
)
x86_isas=(scalar ssse3 sse41 avx2)
# The semi-global matcher has one mode for all caches.
cache_modes_of() { [[ $1 == coarse || $1 == fine ]] && echo large || echo large small; }
# CPU for llvm-mca, kernel, clock in MHz, the board
boards=(
  "silvermont  sse41  1910  Atom E3845 (Silvermont), 1.91 GHz"
  "goldmont    sse41  1100  Pentium N4200 (Goldmont), 1.1 GHz base"
  "goldmont    sse41  2500  Pentium N4200 (Goldmont), 2.5 GHz burst"
  "cortex-a53  neon   1200  Cortex-A53, 1.2 GHz (Raspberry Pi 3 class)"
  "cortex-a72  neon   1500  Cortex-A72, 1.5 GHz (Raspberry Pi 4 class)"
)
small_l1=(--D1=24576,6,64 --LL=1048576,16,64)
covered_percent=97
cycles_per_miss=15  # a guess at what a first-level miss costs when nothing hides it

die() {
  echo "counts.sh: $*" >&2
  exit 1
}
[[ ${1:-} == '' || ${1:-} == --quick ]] || die "usage: tests/bench/counts/counts.sh [--quick]"
[[ ${1:-} != --quick ]] || cases=("${cases[0]}")

for tool in valgrind qemu-x86_64 llvm-mca-14 llvm-objdump-14 cmake; do
  command -v "$tool" >/dev/null || die "no $tool here: toolchain/install-deps.sh --emulation"
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

build() {
  { cmake --preset "$1" && cmake --build --preset "$1" -j "$(nproc)" --target matcher_once; } >"$work/build" 2>&1 ||
    { tail -n 20 "$work/build" >&2; die "preset $1 does not build."; }
}
build core
native=build/core/bin/matcher_once
${CXX:-g++} -std=c++20 -O2 -fPIC -shared tests/bench/counts/count_blocks.cpp -o "$work/count_blocks.so"
arm=
if command -v qemu-aarch64 aarch64-linux-gnu-g++ >/dev/null && [[ -d /usr/src/googletest ]]; then
  build core-arm64
  arm=build/core-arm64/bin/matcher_once
else
  echo "NEON is not measured: no qemu-aarch64, aarch64-linux-gnu-g++ or /usr/src/googletest here."
fi

# Prints instructions and first-level data misses (reads and writes) of a run under cachegrind.
cachegrind() {
  valgrind --tool=cachegrind --cache-sim=yes "${small_l1[@]}" --cachegrind-out-file="$work/cachegrind" "$@" \
    2>"$work/valgrind" || { cat "$work/valgrind" >&2; die "cachegrind: $*"; }
  awk '/^events:/ {for (i = 2; i <= NF; ++i) name[i] = $i}
       /^summary:/ {for (i = 2; i <= NF; ++i) of[name[i]] = $i
                    print of["Ir"], of["D1mr"] + of["D1mw"]}' "$work/cachegrind"
}

# Writes "block ADDRESS INSTRUCTIONS EXECUTIONS" of one frame to the file $1; then the emulator, the program and its
# arguments without the repetitions.
blocks_of_a_frame() {
  local out=$1 emulator=$2
  shift 2
  local repetitions
  for repetitions in 1 3; do
    # shellcheck disable=SC2086  # the emulator's own options are words
    $emulator -plugin "$work/count_blocks.so" -d plugin -D "$work/run$repetitions" "$@" "$repetitions" \
      2>"$work/emulator" || { cat "$work/emulator" >&2; die "$emulator $*"; }
  done
  awk '$1 != "block" {next}
       NR == FNR {once[$2, $3] = $4; next}
       {n = ($4 - once[$2, $3]) / 2; if (n > 0) print $1, $2, $3, n}' "$work/run1" "$work/run3" >"$out"
}

instructions_in() { awk '{sum += $3 * $4} END {printf "%.0f\n", sum}' "$1"; }

# Prints the whole frame's cycles and the share of the instructions (%) that they rest on: llvm-mca's CPU, its
# triple, the program, the file with its blocks.
cycles_of() {
  local cpu=$1 triple=$2 program=$3 blocks=$4
  [[ -f $work/$(basename "$program").$triple.dis ]] ||
    llvm-objdump-14 -d --no-show-raw-insn "$program" >"$work/$(basename "$program").$triple.dis"
  rm -rf "$work/regions"
  mkdir "$work/regions"
  # Joins blocks, takes the hottest, and writes each one's assembly to a file. Targets of jumps become '.', because
  # where they lead does not matter and their addresses mean nothing outside the program.
  awk -v dir="$work/regions" -v percent="$covered_percent" '
    BEGIN {lines = 0; n = 0; regions = 0}
    FNR == 1 {++file}
    file == 1 {
      if ($1 !~ /^[0-9a-f]+:$/) next
      address = $1
      sub(/:$/, "", address)
      text = $0
      sub(/^[ \t]*[0-9a-f]+:[ \t]*/, "", text)
      sub(/[ \t]*(#|\/\/) .*$/, "", text)
      gsub(/(0x)?[0-9a-f]+ <[^>]*>/, ".", text)
      at[lines] = address
      line_of[at[lines]] = lines
      code[lines++] = text
      next
    }
    {
      first[n] = tolower(substr($2, 3)); count[n] = $3; times[n] = $4
      order[first[n]] = n
      total += $3 * $4
      ++n
    }
    END {
      # joined[i]: i is part of an earlier block
      for (i = 0; i < n; ++i) {
        if (joined[i] || !(first[i] in line_of)) continue
        while (1) {
          end_line = line_of[first[i]] + count[i]
          if (!(end_line in at) || !(at[end_line] in order)) break
          next_block = order[at[end_line]]
          if (next_block == i || joined[next_block] || times[next_block] < 0.98 * times[i] ||
              times[next_block] > 1.02 * times[i]) break
          count[i] += count[next_block]
          joined[next_block] = 1
        }
      }
      # The hottest first, by selection; there are few.
      while (covered < total * percent / 100 && regions < 200) {
        best = -1
        for (i = 0; i < n; ++i) {
          if (joined[i] || used[i] || !(first[i] in line_of)) continue
          if (code[line_of[first[i]]] ~ /^rep/) continue  # counted for each byte, and no model knows it
          if (best < 0 || count[i] * times[i] > count[best] * times[best]) best = i
        }
        if (best < 0) break
        used[best] = 1
        covered += count[best] * times[best]
        name = sprintf("%s/%03d.s", dir, regions++)
        for (k = 0; k < count[best]; ++k) print code[line_of[first[best]] + k] > name
        close(name)
        print name, count[best], times[best] > (dir "/list")
      }
    }' "$work/$(basename "$program").$triple.dis" "$blocks"
  local total cycles=0 covered=0 file instructions times region
  total=$(instructions_in "$blocks")
  while read -r file instructions times; do
    # A block with an instruction that the model does not know counts as not covered.
    region=$(llvm-mca-14 -mtriple="$triple" -mcpu="$cpu" -iterations=100 "$file" 2>/dev/null |
      awk '/^Total Cycles:/ {print $3 / 100}') || true
    [[ -n $region ]] || continue
    cycles=$(awk -v a="$cycles" -v b="$region" -v c="$times" 'BEGIN {printf "%.0f", a + b * c}')
    covered=$(awk -v a="$covered" -v b="$instructions" -v c="$times" 'BEGIN {printf "%.0f", a + b * c}')
  done <"$work/regions/list"
  [[ $covered -gt 0 ]] || die "llvm-mca knows none of the hot blocks of $program for $cpu."
  awk -v c="$cycles" -v covered="$covered" -v total="$total" \
    'BEGIN {printf "%.0f %.1f\n", c * total / covered, 100 * covered / total}'
}

per_pixel() { awk -v n="$1" -v pixels="$2" -v digits="$3" 'BEGIN {printf "%.*f", digits, n / pixels}'; }

echo "Instructions and first-level data cache misses (24 KiB, 6 ways) per pixel"
printf '%-34s %-8s %-6s %14s %14s\n' case isa cache instructions misses
declare -A misses
for row in "${cases[@]}"; do
  read -r name width height disparities window matcher subpixel <<<"$row"
  pixels=$((width * height))
  for isa in "${x86_isas[@]}"; do
    for cache in $(cache_modes_of "$matcher"); do
      arguments=("$width" "$height" "$disparities" "$window" "$matcher" "$subpixel" "$isa" "$cache")
      if ! "$native" "${arguments[@]}" 1 2>/dev/null; then
        printf '%-34s %-8s %-6s not available on this CPU\n' "$name" "$isa" "$cache"
        continue
      fi
      read -r once_instructions once_misses <<<"$(cachegrind "$native" "${arguments[@]}" 1)"
      read -r thrice_instructions thrice_misses <<<"$(cachegrind "$native" "${arguments[@]}" 3)"
      misses[$name,$isa,$cache]=$(((thrice_misses - once_misses) / 2))
      printf '%-34s %-8s %-6s %14s %14s\n' "$name" "$isa" "$cache" \
        "$(per_pixel $(((thrice_instructions - once_instructions) / 2)) "$pixels" 1)" \
        "$(per_pixel "${misses[$name,$isa,$cache]}" "$pixels" 3)"
    done
  done
  [[ -n $arm ]] || continue
  for cache in $(cache_modes_of "$matcher"); do
    blocks_of_a_frame "$work/neon" "qemu-aarch64" "$arm" "$width" "$height" "$disparities" "$window" "$matcher" \
      "$subpixel" neon "$cache"
    printf '%-34s %-8s %-6s %14s %14s\n' "$name" "neon 64" "$cache" \
      "$(per_pixel "$(instructions_in "$work/neon")" "$pixels" 1)" "not measured"
  done
done

echo
echo "Cycles by llvm-mca, cache mode small where there is one, and what a frame should take on one core. The misses are those of sse41 in"
echo "the table above at $cycles_per_miss cycles each, none hidden: the truth should lie between the two times."
printf '%-32s %-44s %8s %9s %8s %8s\n' case board cycles/px covered ms "ms+miss"
for row in "${cases[@]}"; do
  read -r name width height disparities window matcher subpixel <<<"$row"
  pixels=$((width * height))
  cache=$(cache_modes_of "$matcher" | awk '{print $NF}')
  declare -A cycles=()
  for board in "${boards[@]}"; do
    read -r cpu isa mhz description <<<"$board"
    if [[ -z ${cycles[$cpu]:-} ]]; then
      arguments=("$width" "$height" "$disparities" "$window" "$matcher" "$subpixel" "$isa" "$cache")
      if [[ $isa == neon ]]; then
        [[ -n $arm ]] || continue
        blocks_of_a_frame "$work/blocks" "qemu-aarch64" "$arm" "${arguments[@]}"
        cycles[$cpu]=$(cycles_of "$cpu" aarch64-linux-gnu "$arm" "$work/blocks")
      else
        blocks_of_a_frame "$work/blocks" "qemu-x86_64 -cpu Denverton" "$native" "${arguments[@]}"
        cycles[$cpu]=$(cycles_of "$cpu" x86_64-linux-gnu "$native" "$work/blocks")
      fi
    fi
    read -r frame covered <<<"${cycles[$cpu]}"
    printf '%-32s %-44s %8s %8s%% %8s %8s\n' "$name" "$description" "$(per_pixel "$frame" "$pixels" 1)" "$covered" \
      "$(awk -v c="$frame" -v mhz="$mhz" 'BEGIN {printf "%.1f", c / mhz / 1000}')" \
      "$(awk -v c="$frame" -v m="${misses[$name,sse41,$cache]:-0}" -v each="$cycles_per_miss" -v mhz="$mhz" \
        'BEGIN {printf "%.1f", (c + m * each) / mhz / 1000}')"
  done
done
