# SPDX-License-Identifier: BSD-3-Clause
# shows: the service under systemd: start, rows, reload, unplug and replug, watchdog, stop; an Atom without AVX
# seconds: 900
. /share/guest/lib.sh
export SYSTEMD_PAGER= SYSTEMD_COLORS=0

# Installs stereod: the package if the host has shared one, else what it would bring.
install_stereod() {
  if compgen -G '/share/stereod_*.deb' >/dev/null; then
    dpkg --install /share/stereod_*.deb
    return
  fi
  install -t /usr/bin /share/bin/stereod
  install -m 644 -t /usr/lib/systemd/system /share/systemd/*.service
  install -m 644 -t /usr/lib/sysusers.d /share/systemd/sysusers.d/stereod.conf
  install -m 644 -t /usr/lib/sysctl.d /share/etc/sysctl.d/00-stereod.conf
  install -m 644 -t /usr/lib/udev/rules.d /share/etc/udev/60-stereod.rules
  systemd-sysusers
  systemctl daemon-reload
  sysctl -q -p /usr/lib/sysctl.d/00-stereod.conf
  udevadm control --reload
}

# write_config NAME PREFIX DISPARITIES [MORE]: /etc/stereod/NAME.yaml, light enough for an emulated processor.
write_config() {
  mkdir -p /etc/stereod
  cat >"/etc/stereod/$1.yaml" <<CONFIG
cameras:
  source: v4l2
  fps: 10
  v4l2: {left: "$(by_path 0)", right: "$(by_path 1)", width: 320, height: 240, format: mjpeg, sync: none ${4:-}}
matcher: {preset: fast, disparities: $3, min_disparity: 8, window: 5, prefilter: none, median: 0}
workers: 1
lcm: {prefix: $2, rows_per_message: 48, pacing: 0.2}
CONFIG
}

property() { systemctl show --property "$1" --value "${2:-stereod.service}"; }
status_says() { text=$(property StatusText) && [[ $text =~ $1 ]]; }
need_status() {
  wait_for "$1" status_says "$2" || { systemctl status stereod; fail "the status should say '$2'"; }
  echo "status: $text"
}
restarted() { [[ $(property NRestarts) -ge $1 ]]; }
not_restarted() { [[ $(property NRestarts) -eq ${1:-0} ]] || fail "it was restarted"; }
streams='^(streaming|uncalibrated): [0-9.]+ fps'
# control_is DEVICE CONTROL VALUE
control_is() { v4l2-ctl --device="$1" --get-ctrl="$2" | grep -q ": $3"; }
journal_says() { journalctl -u stereod -o cat | grep -qE "$1"; }
now_ms() { echo $(($(date +%s%N) / 1000000)); }

# The scenarios after this one find the machine's own route again.
leave() {
  systemctl stop stereod stereod@front stereod-multicast || true
  ip route replace 224.0.0.0/4 dev lo
  echo "=== the journal"
  journalctl -u stereod -u stereod@front -u stereod-multicast -o short-monotonic
}
trap leave EXIT

start_cameras
echo "=== install"
ip route del 224.0.0.0/4 dev lo  # the service has its own
install_stereod
[[ $(sysctl -n net.core.rmem_max) -eq 4194304 ]] || fail "net.core.rmem_max was not raised"
for serial in $left_serial $right_serial; do
  v4l2-ctl --device="$(by_id "$serial")" --set-ctrl=power_line_frequency=2
done
udevadm trigger --action=add --subsystem-match=video4linux --settle
for serial in $left_serial $right_serial; do
  node=$(readlink -f "$(by_id "$serial")")
  [[ $(cat "/sys/class/video4linux/${node##*/}/device/../power/control") == on ]] || fail "autosuspend is on for $node"
  wait_for 90 control_is "$node" power_line_frequency 1 || fail "the power-line frequency of $node was not set"
done
write_config stereod STEREO 8

echo "=== start"
begun=$(now_ms)
systemctl start stereod || fail "systemctl start stereod"
shown "systemctl start came back ready after $(($(now_ms) - begun)) ms"
ip route show 224.0.0.0/4 | tee routes.txt
grep -q 'dev lo .*metric 4096' routes.txt || fail "stereod-multicast.service made no route"
need_status 150 "$streams"
systemctl --no-pager status stereod
pid=$(property MainPID)
[[ $(stat -c %U "/proc/$pid") == stereod ]] || fail "it does not run as stereod"
stereo-tap check --seconds 10 | tee check.txt || true
rows=$(sed -n 's/^rows  *\([0-9]*\)  *\([0-9]*\).*/\2 of \1/p' check.txt)
[[ $rows =~ ^[1-9] ]] || fail "no rows were received"
shown "rows received by another process: $rows; resident memory $(awk '/^VmRSS:/ { print $2 }' "/proc/$pid/status") kB"

echo "=== reload"
write_config stereod STEREO 12
systemctl reload stereod || fail "systemctl reload"
wait_for 90 journal_says "configuration reloaded, cameras kept running: " ||
  fail "the configuration was not reloaded"
need_status 150 "$streams"
write_config stereod STEREO 12 ', controls: {brightness: 40}'
systemctl reload stereod || fail "systemctl reload"
wait_for 90 control_is "$(by_path 0)" brightness 40 || fail "brightness was not set while it streams"
cp /etc/stereod/stereod.yaml good.yaml
echo 'matchr: {}' >>/etc/stereod/stereod.yaml
systemctl reload stereod || fail "systemctl reload"
need_status 150 "matchr: is not a known key; the nearest known key is 'matcher'"
cp good.yaml /etc/stereod/stereod.yaml
systemctl reload stereod || fail "systemctl reload"
need_status 150 "$streams[^;]*(; no calibration is configured.*)?\$"
[[ $(property MainPID) -eq $pid ]] || fail "it was restarted"
shown "after four reloads the same process, $(property StatusText)"

echo "=== unplug and replug"
tell left unplug
need_status 150 '^waiting for cameras: no frames from the left camera; .*unplugged'
sleep 12  # longer than the watchdog's patience
not_restarted
tell left plug
need_status 150 "$streams"

echo "=== watchdog"
kill -STOP "$pid"
wait_for 150 restarted 1 || { systemctl --no-pager status stereod; fail "systemd did not restart what was stopped"; }
need_status 150 "$streams"
[[ $(property MainPID) -ne $pid ]] || fail "it is the same process"

echo "=== another pair of settings beside it"
systemctl stop stereod
write_config front FRONT 8
systemctl start stereod@front || fail "systemctl start stereod@front"
stereo-tap check --prefix FRONT --seconds 5 || true
systemctl stop stereod@front
# By systemd's own words: the tool that asked for it takes its time on an emulated processor. A template's unit is
# forgotten once it has stopped, so its properties say nothing.
took=$(journalctl -u stereod@front -o short-unix | awk '/Stopping/ { begun = $1 } /Deactivated successfully/ { ended = $1 }
  END { if (ended < begun || !begun) exit 1; printf "%d", (ended - begun) * 1000 }') || fail "it did not stop by itself"
shown "stopped within $took ms"

echo "=== real time"
write_config stereod STEREO 8
echo 'scheduling: {priority: 10, cpus: 1}' >>/etc/stereod/stereod.yaml
systemctl start stereod || fail "systemctl start stereod"
need_status 150 'the system refused real-time priority 10 .*; the system refused the CPUs in scheduling.cpus'
mkdir -p /etc/systemd/system/stereod.service.d
cp /share/systemd/examples/realtime.conf /etc/systemd/system/stereod.service.d
systemctl daemon-reload
systemctl restart stereod || fail "systemctl restart stereod"
need_status 150 "$streams"
[[ ! $text =~ refused ]] || fail "with the example's permissions it is still refused"
[[ $(ps -Lo cls=,rtprio= -p "$(property MainPID)") =~ FF\ +10 ]] || fail "no thread has the priority"
systemctl stop stereod
rm -r /etc/systemd/system/stereod.service.d
systemctl daemon-reload

echo "=== a configuration that can never work"
echo 'cameras: {source: telepathy}' >/etc/stereod/stereod.yaml
systemctl start stereod && fail "it started"
[[ $(property ExecMainStatus) -eq 78 ]] || fail "it ended with $(property ExecMainStatus)"
sleep 4
[[ $(property ActiveState) == failed ]] || fail "systemd tries again: $(property ActiveState)"
systemctl --no-pager status stereod || true

echo "=== the end"
systemctl stop stereod-multicast
ip route show 224.0.0.0/4 | grep . && fail "the route stayed"
for sentence in 'left camera: absent|left camera: lost' 'left camera: streaming again' 'Watchdog timeout' \
  "cameras.source: found 'telepathy'"; do
  journal_says "$sentence" || fail "the journal does not say '$sentence'"
done
