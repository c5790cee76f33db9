#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# stereod on one host, a receiver on another: two network namespaces with a cable between them. What is lost on the way is
# measured with a time to live of 1; with 0 nothing may get out; and with the firewall line of docs/service.md nothing does.
#
#   two_hosts.sh DIRECTORY-OF-PROGRAMS
#
# Ends with 77, skipped, where no namespaces can be made.
set -euo pipefail
bin=$(realpath "${1:?two_hosts.sh DIRECTORY-OF-PROGRAMS}")

fail() {
  echo "two_hosts: FAILED: $*" >&2
  exit 1
}

"$bin/stereod" --version >/dev/null 2>&1 || [[ $? -ne 126 ]] || {
  echo "two_hosts: the programs are for another architecture: skipped."
  exit 77
}
if [[ ${2:-} != --inside ]]; then
  for flags in -rn -n; do
    if unshare "$flags" true 2>/dev/null; then exec unshare "$flags" "$0" "$bin" --inside; fi
  done
  echo "two_hosts: this machine does not allow network namespaces: skipped."
  exit 77
fi

scratch=$(mktemp -d)
children=()
clean_up() {
  [[ ${#children[@]} -eq 0 ]] || kill "${children[@]}" 2>/dev/null || true
  wait
  rm -rf "$scratch"
}
trap clean_up EXIT

# The robot is this namespace, the other host the one of a process that only sleeps.
unshare -n sleep infinity &
base=$!
children+=("$base")
until [[ $(readlink "/proc/$base/ns/net") != $(readlink /proc/self/ns/net) ]]; do sleep 0.05; done
at_base() { nsenter --target "$base" --net "$@"; }
ip link set lo up
if ! ip link add name veth0 type veth peer name veth1 2>/dev/null; then
  echo "two_hosts: this kernel has no virtual cable (veth): skipped."
  exit 77
fi
ip link set veth1 netns "$base"
ip address add 10.77.0.1/24 dev veth0
ip link set veth0 up
ip route add 224.0.0.0/4 dev veth0
at_base ip address add 10.77.0.2/24 dev veth1
at_base ip link set lo up
at_base ip link set veth1 up
at_base ip route add 224.0.0.0/4 dev veth1

# stream TTL: starts stereod.
stream() {
  cat >"$scratch/stereod.yaml" <<CONFIG
cameras: {source: synthetic, fps: 15, synthetic: {width: 320, height: 240}}
lcm: {url: "udpm://239.255.76.67:7667?ttl=$1", prefix: ROBOT1}
CONFIG
  "$bin/stereod" --config "$scratch/stereod.yaml" 2>"$scratch/stereod.log" &
  stereod=$!
  children+=("$stereod")
  for _ in {1..200}; do
    grep -q 'state: streaming' "$scratch/stereod.log" && return
    sleep 0.1
  done
  cat "$scratch/stereod.log" >&2
  fail "stereod does not stream"
}
stop_stream() {
  kill -TERM "$stereod"
  wait "$stereod" || fail "stereod ended with $?"
  children=("$base")
}
# check SECONDS: what the other host receives; the status of stereo-tap check in $status.
check() {
  status=0
  at_base "$bin/stereo-tap" check --seconds "$1" --prefix ROBOT1 --lcm-url 'udpm://239.255.76.67:7667?ttl=0' \
    >"$scratch/check.txt" 2>"$scratch/check.err" || status=$?
}
nothing_arrived=2

stream 1
check 6
cat "$scratch/check.txt" "$scratch/check.err"
[[ $status -eq 0 ]] || fail "with ttl=1 stereo-tap check ended with $status on the other host"
rows=$(sed -n 's/^rows  *[0-9]*  *\([0-9]*\) .*/\1/p' "$scratch/check.txt")
[[ $rows -gt 0 ]] || fail "no rows were received"

if command -v nft >/dev/null && nft list ruleset >/dev/null 2>&1; then
  nft add table inet stereod
  nft add chain inet stereod output '{ type filter hook output priority 0; }'
  nft add rule inet stereod output oifname != lo ip daddr 239.255.76.67 udp dport 7667 drop
  check 2
  [[ $status -eq $nothing_arrived ]] || { cat "$scratch/check.txt"; fail "the firewall's line let something through"; }
  echo "two_hosts: with the firewall's line nothing arrived."
  nft delete table inet stereod
else
  echo "two_hosts: no nft, or a kernel without it: the firewall's line was not tried."
fi
stop_stream

stream 0
check 2
[[ $status -eq $nothing_arrived ]] || { cat "$scratch/check.txt"; fail "with ttl=0 something left the machine"; }
echo "two_hosts: with ttl=0 nothing arrived."
stop_stream
