#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What a part of the image saves: the table of docs/consumers.md. stereod renders its scene at 640×480, 30 images a
# second, with one worker; stereo-tap listens. Wants an idle machine.
#
#   region_table.sh DIRECTORY-OF-PROGRAMS [SECONDS-FOR-EACH]
set -euo pipefail
bin=$(realpath "${1:?region_table.sh DIRECTORY-OF-PROGRAMS [SECONDS-FOR-EACH]}")
seconds=${2:-8}
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
if [[ ${3:-} != --inside ]]; then
  exec "$here/../../toolchain/own-network.sh" bash "$0" "$bin" "$seconds" --inside
fi

export LCM_DEFAULT_URL='udpm://239.255.76.67:17676?ttl=0'
scratch=$(mktemp -d)
daemon=
clean_up() {
  [[ -z $daemon ]] || kill "$daemon" 2>/dev/null || true
  wait
  rm -rf "$scratch"
}
trap clean_up EXIT

# Bytes sent to multicast addresses so far, headers included.
multicast_bytes() {
  awk '$1 == "IpExt:" { if (!n) { n = split($0, names) } else { for (i = 1; i <= n; i++) if (names[i] == "OutMcastOctets") print $i } }' \
    /proc/net/netstat
}

# row NAME PUBLISH: what the status says after $seconds seconds, and the bytes sent in that time.
row() {
  printf 'cameras: {source: synthetic, fps: 30}\nworkers: 1\npublish: {%s}\n' "$2" >"$scratch/stereod.yaml"
  "$bin/stereod" --config "$scratch/stereod.yaml" 2>"$scratch/stereod.err" &
  daemon=$!
  sleep 2
  local before after
  before=$(multicast_bytes)
  sleep "$seconds"
  after=$(multicast_bytes)
  "$bin/stereo-tap" status --once | awk -v name="$1" -v bytes=$((after - before)) -v seconds="$seconds" '
    $1 == "matching" { match_ms = $2 }
    /CPU/ { cpu = $(NF - 1) }
    END { printf "| %s | %s | %.0f | %.1f |\n", name, match_ms, cpu, bytes / seconds / 1e6 }'
  kill "$daemon"
  wait "$daemon" || true
  daemon=
}

printf '| published | matching, ms | CPU, %% of a core | network, MB/s |\n|---|---|---|---|\n'
row 'all' ''
row 'the lower half' 'region: {top: 240}'
row 'the middle third of the rows' 'region: {top: 160, height: 160}'
row 'the middle third of the columns' 'region: {left: 213, width: 214}'
row 'the middle third of both' 'region: {left: 213, top: 160, width: 214, height: 160}'
row 'every second column and row' 'decimation_x: 2, decimation_y: 2'
