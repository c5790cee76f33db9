#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures what stereod takes of a small board. Held to a limit: the size of the stripped binary, and resident memory at
# 640×480. Printed: the time from start to the first published pair, and the CPU share while waiting for cameras.
#   footprint.sh DIRECTORY-OF-PROGRAMS
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
bin=$(realpath "${1:?footprint.sh DIRECTORY-OF-PROGRAMS}")
max_binary=2500000  # bytes
max_memory=40960    # KiB

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
  fail "stereod did not log '$1'"
}
now_ms() { echo $(($(date +%s%N) / 1000000)); }

strip -o "$scratch/stripped" "$bin/stereod"
size=$(stat -c %s "$scratch/stripped")
echo "footprint: stripped binary: $size bytes (limit $max_binary)"
[[ $size -le $max_binary ]] || fail "the stripped binary exceeds its limit"

# Images are available at once, as from cameras that already stream.
for side in left right; do
  { printf 'P5\n640 480\n255\n' && head -c $((640 * 480)) /dev/urandom; } >"$scratch/$side.pgm"
done
echo 'cameras: {source: replay, replay: {left: left.pgm, right: right.pgm, loop: true}}' >"$scratch/images.yaml"
"$bin/stereo-tap" save --frames 1 --timeout 60 --out "$scratch" >/dev/null &
receiver=$!
sleep 1
begun=$(now_ms)
start "$scratch/images.yaml"
wait "$receiver" || fail "no frame was received"
echo "footprint: from the start to the first frame received by another process, and written: $(($(now_ms) - begun)) ms"
stop

start etc/demo.yaml
says 'state: streaming'
sleep 5
memory=$(awk '/^VmRSS:/ { print $2 }' "/proc/$daemon/status")
stop
echo "footprint: resident memory at 640×480: $memory KiB (limit $max_memory)"
[[ $memory -le $max_memory ]] || fail "resident memory exceeds its limit"

echo "cameras: {source: v4l2, v4l2: {left: 'serial:NONE-1', right: 'serial:NONE-2'}}" >"$scratch/waiting.yaml"
start "$scratch/waiting.yaml"
says 'state: waiting'
ticks() { awk '{ print $14 + $15 }' "/proc/$daemon/stat"; }
before=$(ticks)
sleep 10
spent=$(($(ticks) - before))
stop
awk -v t="$spent" -v hz="$(getconf CLK_TCK)" 'BEGIN { printf "footprint: while it waits for cameras: %.2f %% of one CPU\n", t / hz / 10 * 100 }'
