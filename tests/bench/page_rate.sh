#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How many images a second stereo-view's page shows over a slow link: stereod, stereo-view and a headless Chromium in a
# network namespace whose loopback, which carries nothing but the page, is limited to MBIT Mbit/s (0: not limited).
#
#   page_rate.sh DIRECTORY-OF-PROGRAMS MBIT...
set -euo pipefail
bin=$(realpath "${1:?page_rate.sh DIRECTORY-OF-PROGRAMS MBIT...}")
if [[ ${2:-} != --inside ]]; then exec unshare -n bash "$0" "$bin" --inside "${@:2}"; fi
shift 2

scratch=$(mktemp -d)
children=()
clean_up() {
  [[ ${#children[@]} -eq 0 ]] || kill "${children[@]}" 2>/dev/null || true
  wait
  rm -rf "$scratch"
}
trap clean_up EXIT

# Disparity rows have an interface of their own.
ip link set lo up mtu 1500
ip link add rows0 type veth peer name rows1
ip address add 10.77.1.1/24 dev rows0
ip link set rows0 up mtu 65535
ip link set rows1 up mtu 65535
ip route add 224.0.0.0/4 dev rows0
export LCM_DEFAULT_URL='udpm://239.255.76.67:17675?ttl=0'
printf 'cameras: {source: synthetic, fps: 30}\nscan: {enabled: true}\nlcm: {left_image: jpeg}\n' >"$scratch/stereod.yaml"
"$bin/stereod" --config "$scratch/stereod.yaml" 2>"$scratch/stereod.err" &
children+=($!)
"$bin/stereo-view" --port 8091 >"$scratch/view.out" 2>&1 &
children+=($!)
sleep 2
for mbit in "$@"; do
  tc qdisc del dev lo root 2>/dev/null || true
  [[ $mbit -eq 0 ]] || tc qdisc add dev lo root tbf rate "${mbit}mbit" burst 32kbit latency 100ms
  printf '%s Mbit/s: ' "$mbit"
  "$bin/page_rate" http://127.0.0.1:8091/ 6
done
