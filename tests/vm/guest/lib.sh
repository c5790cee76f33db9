# What the scenarios share. Source it first.
set -euo pipefail

left_serial=LEFT01
right_serial=RIGHT01

fail() {
  echo "FAILED: $*"
  exit 1
}

# A finding that run.sh repeats in its summary.
shown() { echo "shown: $*"; }

# Waits up to SECONDS until the command succeeds.
wait_for() {
  local seconds=$1 end
  shift
  end=$((SECONDS + seconds))
  until "$@"; do
    [[ $SECONDS -lt $end ]] || return 1
    sleep 0.2
  done
}

by_id() { echo "/dev/v4l/by-id/usb-uvcsim_UVC_Sim_Camera_$1-video-index0"; }
# Port N of the virtual USB controller, from 0.
by_path() { echo "/dev/v4l/by-path/platform-vhci_hcd.0-usb-0:$(($1 + 1)):1.0-video-index0"; }

# Two webcams, the left one at port 0 and the right one at port 1. Arguments: for uvcvideo.
start_cameras() {
  modprobe vhci-hcd
  modprobe uvcvideo "$@"
  uvcsim --port 0 --serial "$left_serial" --control left.pipe &
  uvcsim --port 1 --serial "$right_serial" --right --control right.pipe &
  wait_for 30 test -e "$(by_id $left_serial)" || fail "the left camera did not appear"
  wait_for 30 test -e "$(by_id $right_serial)" || fail "the right camera did not appear"
}

# tell left|right|both COMMAND…
tell() {
  local side sides=$1
  shift
  if [[ $sides == both ]]; then sides="left right"; fi
  for side in $sides; do echo "$*" >"$side.pipe"; done
}

# Starts stereod, set up for two cameras and light enough for an emulated processor. Arguments: left and right device,
# format, and further lines for cameras.v4l2; fps, size and matcher from variables. Its configuration is in ./stereod.yaml, its log in ./stereod.log.
start_stereod() {
  local size=${size:-640x480}
  cat >stereod.yaml <<CONFIG
cameras:
  source: v4l2
  fps: ${fps:-30}
  v4l2:
    left: $1
    right: $2
    width: ${size%x*}
    height: ${size#*x}
    format: $3
    ${4:-align: never}
matcher: { ${matcher:-preset: fast, disparities: 8, min_disparity: 8} }
workers: 1
lcm: { spread: 0.2, rows_per_message: 48 }
CONFIG
  stereod --config stereod.yaml >stereod.log 2>&1 &
  stereod_pid=$!
}

stop_stereod() {
  local status=0
  kill -TERM "$stereod_pid"
  wait "$stereod_pid" || status=$?
  [[ $status -eq 0 ]] || fail "stereod ended with $status"
}

# The latest status, as a table, in ./status.txt.
get_status() { stereo-tap status --once --timeout 8 >status.txt 2>status.err; }

# A row of the status table of both cameras: the left and the right value.
camera_row() { sed -n "s/^  $1  *//p" status.txt | head -n 1; }
# A row of that table with the lines it goes on in, as one line.
whole_row() {
  awk -v label="  $1 " 'index($0, label) == 1 { on = 1; print; next } /^ ? ?[^ ]|^$/ { on = 0 } on' status.txt |
    tr -s ' \n' ' '
}
# One number behind a label of the table.
number_of() { sed -n "s/.*$1  *\([0-9][0-9.]*\).*/\1/p" status.txt | head -n 1; }

says() { get_status && grep -qE "$1" status.txt; }
both_stream() { get_status && [[ $(camera_row state) =~ ^streaming\ +streaming ]]; }
frames_flow() {
  both_stream && awk -v f="$(number_of 'frames out')" 'BEGIN { exit !(f > 0) }'
}

need_streaming() {
  wait_for "${1:-40}" frames_flow || { cat status.txt stereod.log; fail "${2:-both cameras should stream}"; }
}

descriptors() { find "/proc/$stereod_pid/fd" -mindepth 1 | wc -l; }
memory_kb() { awk '/^VmRSS:/ { print $2 }' "/proc/$stereod_pid/status"; }
