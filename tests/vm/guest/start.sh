#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the scenarios that the host has put into /share, one after the other, tells the host how each went, and turns the
# machine off.
export TERM=dumb PATH=/share/bin:/usr/sbin:/usr/bin:/sbin:/bin

# Runs one in a control group of its own, so that nothing of it outlives it.
run() {
  local name=$1 directory=/run/scenario/$1 share=/share/$1 status=0 start=$SECONDS
  mkdir -p "$directory"
  dmesg -C
  {
    systemd-run --quiet --wait --pipe --collect --working-directory="$directory" --setenv=PATH --setenv=TERM \
      --property=RuntimeMaxSec="$(cat "$share/seconds")" --property=TimeoutStopSec=5 \
      bash "$share/scenario.sh" </dev/null || status=$?
    [[ $((SECONDS - start)) -lt $(cat "$share/seconds") ]] || echo "--- it did not end in time"
    if [[ $status -ne 0 ]]; then
      echo "--- the kernel said:"
      dmesg | grep -v vhci_hcd | tail -n 30
      rm -f "$directory"/*.pipe
      cp -r "$directory" "$share/left-behind"
    fi
    unload
  } >"$share/log" 2>&1
  echo "$status $((SECONDS - start))" >"$share/result.new"
  mv "$share/result.new" "$share/result"
}

# The next scenario finds no camera of this one's. A module is free once the kernel has seen that its users are gone.
unload() {
  local module tries
  for module in uvcvideo vhci_hcd v4l2loopback vivid; do
    for tries in {1..25}; do
      [[ -d /sys/module/$module ]] || break
      modprobe -q -r "$module" || sleep 0.2
    done
    [[ ! -d /sys/module/$module ]] || echo "--- $module cannot be unloaded"
  done
  udevadm settle
}

{
  # LCM needs a route for multicast, and stereo-tap a roomy socket buffer.
  ip link set lo up
  ip route add 224.0.0.0/4 dev lo
  sysctl -qw net.core.rmem_max=4194304
  echo "booted in $(cut -d' ' -f1 /proc/uptime) s"
  while read -r name; do run "$name"; done </share/order
} >/share/machine.log 2>&1
sync
systemctl poweroff -ff
