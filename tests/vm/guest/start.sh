#!/usr/bin/env bash
# Runs the scenario that the host has put into /share, tells the host how it went, and turns the machine off.
export TERM=dumb PATH=/share/bin:/usr/sbin:/usr/bin:/sbin:/bin
uptime_seconds() { cut -d' ' -f1 /proc/uptime; }
{
  echo "--- booted in $(uptime_seconds) s"
  # LCM needs a route for multicast, and stereo-tap a roomy socket buffer.
  ip link set lo up
  ip route add 224.0.0.0/4 dev lo
  sysctl -qw net.core.rmem_max=4194304
  mkdir -p /run/scenario
  cd /run/scenario || exit
  timeout -k 5 "$(cat /share/seconds)" bash /share/scenario.sh
  status=$?
  [[ $status -ne 124 ]] || echo "--- it did not end in time"
  if [[ $status -ne 0 ]]; then
    echo "--- the kernel said:"
    dmesg | tail -n 60
    mkdir -p /share/left-behind
    cp -r /run/scenario/. /share/left-behind 2>/dev/null
  fi
  echo "--- ended with $status after $(uptime_seconds) s"
} >/share/log 2>&1
echo "$status" >/share/status
sync
systemctl poweroff -ff
