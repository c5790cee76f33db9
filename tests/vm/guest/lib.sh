# SPDX-License-Identifier: BSD-3-Clause
# Functions and variables of all scenarios. Source it first.
set -euo pipefail

# An emulated processor does vector instructions more slowly than plain ones; this is libjpeg-turbo's switch.
export JSIMD_FORCENONE=1

left_serial=LEFT01
right_serial=RIGHT01

fail() {
  echo "FAILED: $*"
  exit 1
}

# Prints a finding, which run.sh repeats in its summary.
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

# Plugs in two webcams, the left one at port 0 and the right one at port 1. Arguments: options of uvcvideo.
start_cameras() {
  modprobe vhci-hcd
  modprobe uvcvideo "$@"
  uvcsim --port 0 --serial "$left_serial" --control left.pipe &
  uvcsim --port 1 --serial "$right_serial" --right --control right.pipe &
  wait_for 30 test -e "$(by_id $left_serial)" || fail "the left camera did not appear"
  wait_for 30 test -e "$(by_id $right_serial)" || fail "the right camera did not appear"
}

# tell left|right|both COMMAND…: sends a command to the webcams.
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
    ${4:-sync: none}
matcher: { ${matcher:-preset: fast, disparities: 8, min_disparity: 8} }
workers: 1
lcm: { pacing: 0.2, rows_per_message: 48 }
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

# Writes the latest status, as a table, to ./status.txt.
get_status() { stereo-tap status --once --timeout 8 >status.txt 2>status.err; }

# of_camera left|right ROW: prints the row of the latest status for a camera. Joins a text of several lines.
of_camera() {
  awk -v side="$1" -v label="  $2 " '
    /^camera / { right = index($0, " right") }
    index($0, label) == 1 { on = 1 }
    on && index($0, label) != 1 && /^ ? ?[^ ]|^$/ { exit }
    on { print side == "left" ? substr($0, 17, right - 17) : substr($0, right) }' status.txt | tr -s ' \n' ' ' |
    sed 's/^ //; s/ $//'
}
# says SIDE ROW PATTERN [ROW PATTERN]…: fetches the status; succeeds if the rows of the camera match.
says() {
  local side=$1
  shift
  get_status || return 1
  while [[ $# -gt 0 ]]; do
    [[ $(of_camera "$side" "$1") =~ $2 ]] || return 1
    shift 2
  done
}
# Waits until the rows match.
need() { wait_for 20 says "$@" || { cat status.txt; tail -n 20 stereod.log; fail "the status should say: $*"; }; }
# Prints a count of a camera: the first number of the row.
count_of() { of_camera "$1" "$2" | sed 's/[^0-9].*//'; }
# Prints the first number after a label of the table.
number_of() { sed -n "s/.*$1  *\([0-9][0-9.]*\).*/\1/p" status.txt | head -n 1; }

both_stream() { says left state ^streaming && [[ $(of_camera right state) == streaming ]]; }
frames_flow() {
  both_stream && awk -v f="$(number_of 'frames out')" 'BEGIN { exit !(f > 0) }'
}

need_streaming() {
  wait_for "${1:-40}" frames_flow || { cat status.txt stereod.log; fail "${2:-both cameras should stream}"; }
}

descriptors() { find "/proc/$stereod_pid/fd" -mindepth 1 | wc -l; }
memory_kb() { awk '/^RssAnon:/ { print $2 }' "/proc/$stereod_pid/status"; }

# After each fault both cameras must stream again, with as many descriptors and as much memory as before. A first fault may
# allocate: call remember_resources after it. Memory means anonymous pages (file pages come and go with the page cache). Heap
# fragmentation differs between setups of a camera, so up to max_pages_more pages more are allowed.
page_kb=$(($(getconf PAGESIZE) / 1024))
max_pages_more=32
remember_resources() {
  base_descriptors=$(descriptors)
  base_memory=$(memory_kb)
}
# During the search for a camera one more descriptor is open for a short time.
as_many_descriptors() { [[ $(descriptors) -eq $base_descriptors ]]; }
need_recovery() {
  need_streaming 40 "after $1 both cameras should stream"
  wait_for 10 as_many_descriptors || { ls -l "/proc/$stereod_pid/fd"; fail "$1: $base_descriptors descriptors before"; }
  grown=$(($(memory_kb) - base_memory))
  echo "after $1: $(descriptors) descriptors, memory $(memory_kb) kB"
  [[ $grown -le $((max_pages_more * page_kb)) ]] || fail "after $1 the memory has grown by $grown kB"
}
