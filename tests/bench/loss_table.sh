#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many rows are lost, and how late a frame is, for 1, 2 and 4 consumers on the daemon's machine, usual and raised socket
# buffers, and several rows a message. Prints two tables for docs/loss.md and docs/latency.md. The stereod of the build
# directory renders its scene at 640×480, 30 images a second; the consumers are stereo-tap check. Wants an idle machine.
#
#   loss_table.sh DIRECTORY-OF-PROGRAMS [SECONDS-FOR-EACH]
set -euo pipefail
bin=$(realpath "${1:?loss_table.sh DIRECTORY-OF-PROGRAMS [SECONDS-FOR-EACH]}")
seconds=${2:-5}
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
if [[ ${3:-} != --inside ]]; then
  exec "$here/../../toolchain/own-network.sh" bash "$0" "$bin" "$seconds" --inside
fi

url='udpm://239.255.76.67:17672?ttl=0'
scratch=$(mktemp -d)
daemon=
clean_up() {
  [[ -z $daemon ]] || kill "$daemon" 2>/dev/null || true
  wait
  rm -rf "$scratch"
}
trap clean_up EXIT

# start ROWS: starts a daemon that sends ROWS rows a message.
start() {
  printf 'cameras: {source: synthetic, fps: 30}\nlcm: {url: "%s", rows_per_message: %s}\n' "$url" "$1" >"$scratch/stereod.yaml"
  "$bin/stereod" --config "$scratch/stereod.yaml" 2>"$scratch/stereod.err" &
  daemon=$!
  sleep 2
}
stop() {
  kill "$daemon"
  wait "$daemon" || true
  daemon=
}

# listen CONSUMERS BUFFER: "lost rows, expected rows, latency when sent (median), when here (median, worst 95 %)", all
# consumers together.
listen() {
  local i children=()
  for ((i = 0; i < $1; i++)); do
    "$bin/stereo-tap" --lcm-url "$url&recv_buf_size=$2" check --seconds "$seconds" >"$scratch/check.$i" 2>/dev/null &
    children+=($!)
  done
  for i in "${children[@]}"; do wait "$i" || true; done  # status 3: something was lost
  cat "$scratch"/check.* | awk '
    $1 == "rows" && NF == 4 { expected += $2; lost += $4 }
    /last row sent/ { sent += $(NF - 2); n++ }
    /frame complete/ { here += $(NF - 2); if ($(NF - 1) > worst) worst = $(NF - 1) }
    END { if (n == 0) n = 1; printf "%d %d %.1f %.1f %.1f", lost, expected, sent / n, here / n, worst }'
  rm -f "$scratch"/check.*
}

loss=$scratch/loss late=$scratch/late
columns='| rows a message | 1 | 2 | 4 | 1, raised | 2, raised | 4, raised |'
for table in "$loss" "$late"; do printf '%s\n|---|---|---|---|---|---|---|\n' "$columns" >"$table"; done
for rows in 1 2 4 8 16 32 47; do
  start "$rows"
  lost_line="| $rows |" late_line="| $rows |"
  for buffer in 212992 4194304; do
    for consumers in 1 2 4; do
      read -r lost expected sent here worst < <(listen "$consumers" "$buffer"; echo)
      lost_line+=" $(awk -v l="$lost" -v e="$expected" 'BEGIN { if (l == 0) print "0"; else printf "%d of %d (%.3f %%)\n", l, e, 100 * l / e }') |"
      late_line+=" $sent, $here, $worst |"
    done
  done
  stop
  echo "$lost_line" >>"$loss"
  echo "$late_line" >>"$late"
  echo "$rows rows a message: done; load $(cut -d' ' -f1 /proc/loadavg)" >&2
done
printf 'Rows lost of those expected, all consumers together; by the number of consumers, with the usual buffer of 212,992 bytes and with\n4 MB:\n\n'
cat "$loss"
printf '\nms from the later exposure until the last row was sent (median), until the whole frame was there (median, and the worst 95 %% of any\nconsumer):\n\n'
cat "$late"
