# SPDX-License-Identifier: BSD-3-Clause
# shows: the package under systemd: install, start, rows, upgrade over a running service, remove, purge
# seconds: 600
# needs: package
. /share/guest/lib.sh
export SYSTEMD_PAGER= SYSTEMD_COLORS=0 DEBIAN_FRONTEND=noninteractive

property() { systemctl show --property "$1" --value stereod.service; }
status_says() { text=$(property StatusText) && [[ $text =~ $1 ]]; }
streams() {
  wait_for 150 status_says '^(streaming|uncalibrated): [0-9.]+ fps' ||
    { systemctl status stereod; journalctl -u stereod -o cat; fail "it does not stream"; }
}
# The scenarios after this one find the machine's own route again.
leave() {
  systemctl stop stereod stereod-multicast 2>/dev/null || true
  ip route replace 224.0.0.0/4 dev lo
  sysctl -qw net.core.rmem_max=4194304
  rm -rf /etc/stereod
  echo "=== the journal"
  journalctl -u stereod -o short-monotonic
}
trap leave EXIT

start_cameras
ip route del 224.0.0.0/4 dev lo  # the service has its own
if dpkg-query -W stereod 2>/dev/null; then dpkg --purge stereod; fi
echo "=== install"
dpkg --install /share/stereod_*.deb
[[ $(systemctl is-enabled stereod) == disabled ]] || fail "it has enabled itself"
[[ $(property ActiveState) == inactive ]] || fail "it has started itself"
cat >/etc/stereod/stereod.yaml <<CONFIG
cameras:
  source: v4l2
  fps: 10
  v4l2: {left: "$(by_path 0)", right: "$(by_path 1)", width: 320, height: 240, format: mjpeg, sync: none}
matcher: {preset: fast, disparities: 8, min_disparity: 8, window: 5, prefilter: none, median: 0}
workers: 1
lcm: {rows_per_message: 48, pacing: 0.2}
CONFIG

echo "=== start"
systemctl start stereod || fail "systemctl start stereod"
streams
shown "$(grep -m 1 'model name' /proc/cpuinfo | sed 's/.*: //'): $text $(journalctl -u stereod -o cat | grep -oE 'matcher [^,]*' | tail -n 1)"
stereo-tap check --seconds 10 | tee check.txt || true
rows=$(sed -n 's/^rows  *\([0-9]*\)  *\([0-9]*\).*/\2 of \1/p' check.txt)
[[ $rows =~ ^[1-9] ]] || fail "no rows were received"
shown "rows received by another process: $rows"

echo "=== the package again, over the running service"
pid=$(property MainPID)
cp /etc/stereod/stereod.yaml mine.yaml
dpkg --force-confold --install /share/stereod_*.deb
cmp mine.yaml /etc/stereod/stereod.yaml || fail "the configuration was overwritten"
[[ $(property ActiveState) == active && $(property MainPID) -ne $pid ]] || fail "it was not restarted"
streams

echo "=== remove"
dpkg --remove stereod
[[ $(property ActiveState) != active ]] || fail "removed, it still runs"
[[ $(property LoadState) == not-found ]] || fail "removed, its unit is still there"
[[ -z $(ip route show 224.0.0.0/4) ]] || fail "removed, its route is still there"
cmp mine.yaml /etc/stereod/stereod.yaml || fail "removing took the configuration"

echo "=== install again; enabled, removed and installed once more"
dpkg --install /share/stereod_*.deb
[[ $(property ActiveState) == inactive ]] || fail "it has started itself"
systemctl enable --now stereod || fail "systemctl enable --now stereod"
sysctl -qw net.core.rmem_max=33554432
dpkg --remove stereod
dpkg --install /share/stereod_*.deb
[[ $(property ActiveState) == active ]] || fail "it was enabled before it was removed, and does not run again"
[[ $(sysctl -n net.core.rmem_max) -eq 33554432 ]] || fail "the installation has lowered net.core.rmem_max"

echo "=== purge while it runs"
dpkg --purge stereod
[[ ! -e /etc/stereod && ! -e /var/lib/stereod && ! -e /usr/bin/stereod ]] || fail "purged, something is left"
! getent passwd stereod || fail "purged, its user is left"
[[ -z $(pgrep -x stereod) ]] || fail "purged, it still runs"
shown "upgraded while it ran, removed, started again where it was enabled, purged while it ran"
