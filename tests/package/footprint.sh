#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What stereod takes of a small board: the size of its stripped binary and its resident memory at 640×480, which must stay below
# what is promised; and, only told, the time from its start to the first published pair and the CPU's share while it waits for
# cameras.
#   footprint.sh FOLDER-OF-PROGRAMS
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=$(realpath "${1:?footprint.sh FOLDER-OF-PROGRAMS}")
largest_binary=1500000  # bytes
largest_memory=40960    # KiB

fail() {
  echo "footprint: FAILED: $*" >&2
  exit 1
}
"$bin/stereod" --version >/dev/null 2>&1 || [[ $? -ne 126 ]] || {
  echo "footprint: the programs are for another architecture: skipped."
  exit 77
}
if [[ ${2:-} != --inside ]]; then
  toolchain/own-network.sh --possible || { echo "footprint: no network namespace here: skipped." && exit 77; }
  exec toolchain/own-network.sh "$0" "$bin" --inside
fi

scratch=$(mktemp -d)
daemon=
clean_up() {
  [[ -z $daemon ]] || kill -KILL "$daemon" 2>/dev/null || true
  rm -rf "$scratch"
}
trap clean_up EXIT
start() {
  "$bin/stereod" --config "$1" 2>"$scratch/log" &
  daemon=$!
}
stop() {
  kill -TERM "$daemon"
  wait "$daemon" || fail "stereod ended with $?"
  daemon=
}
says() {
  local tries
  for tries in {1..3000}; do
    ! grep -q "$1" "$scratch/log" || return 0
    sleep 0.02
  done
  cat "$scratch/log" >&2
  fail "stereod does not say '$1'"
}
now_ms() { echo $(($(date +%s%N) / 1000000)); }

strip -o "$scratch/stripped" "$bin/stereod"
size=$(stat -c %s "$scratch/stripped")
echo "footprint: stripped binary: $size bytes; allowed are $largest_binary"
[[ $size -le $largest_binary ]] || fail "the binary is too large"

# Images are there at once, as from cameras that stream already.
for side in left right; do
  { printf 'P5\n640 480\n255\n' && head -c $((640 * 480)) /dev/urandom; } >"$scratch/$side.pgm"
done
echo 'cameras: {source: replay, replay: {left: left.pgm, right: right.pgm, loop: true}}' >"$scratch/pictures.yaml"
"$bin/stereo-tap" save --frames 1 --timeout 60 --out "$scratch" >/dev/null &
receiver=$!
sleep 1
begun=$(now_ms)
start "$scratch/pictures.yaml"
wait "$receiver" || fail "no frame was received"
echo "footprint: from the start to the first frame received by another process, and written: $(($(now_ms) - begun)) ms"
stop

start etc/demo.yaml
says 'state: streaming'
sleep 5
memory=$(awk '/^VmRSS:/ { print $2 }' "/proc/$daemon/status")
stop
echo "footprint: resident memory at 640×480: $memory KiB; allowed are $largest_memory"
[[ $memory -le $largest_memory ]] || fail "it takes too much memory"

echo "cameras: {source: v4l2, v4l2: {left: 'serial:NONE-1', right: 'serial:NONE-2'}}" >"$scratch/waiting.yaml"
start "$scratch/waiting.yaml"
says 'state: waiting'
ticks() { awk '{ print $14 + $15 }' "/proc/$daemon/stat"; }
before=$(ticks)
sleep 10
spent=$(($(ticks) - before))
stop
awk -v t="$spent" -v hz="$(getconf CLK_TCK)" 'BEGIN { printf "footprint: while it waits for cameras: %.2f %% of one CPU\n", t / hz / 10 * 100 }'
