#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# stereod-spy on a screen of its own, and the examples in Java and Python, with a real stereod.
#
#   run.sh BIN-DIRECTORY SHARE-DIRECTORY [SCREENSHOT.png]     exit status 77: it cannot be done here
set -euo pipefail
bin=$1
share=$2
screenshot=${3:-}
examples=$(cd "$(dirname "${BASH_SOURCE[0]}")/../examples" && pwd)
classpath=/usr/share/java/lcm.jar:$share/stereod-spy.jar

skip() {
  echo "skipped: $*"
  exit 77
}
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
for tool in java Xvfb xdotool; do
  command -v "$tool" >/dev/null || skip "$tool is missing (Debian: default-jre xvfb xdotool)"
done
"$bin/stereod" --version >/dev/null 2>&1 || [[ $? -ne 126 ]] || skip "the programs are for another architecture"
[[ -r $share/stereod-spy.jar ]] || skip "stereod-spy was not built"
[[ -n $(ip route get 239.255.76.67 2>/dev/null) ]] || skip "no route for multicast"

work=$(mktemp -d)
children=()
clean_up() {
  local child
  for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT

# Waits up to a minute for a command to succeed.
wait_until() {
  local i
  for ((i = 0; i < 600; i++)); do
    "$@" && return 0
    sleep 0.1
  done
  return 1
}

export LCM_DEFAULT_URL='udpm://239.255.76.67:17669?ttl=0'
cat >"$work/stereod.yaml" <<YAML
cameras: {source: synthetic, fps: 15}
scan: {enabled: true}
lcm: {prefix: SPY, left_image: jpeg}
YAML
"$bin/stereod" --config "$work/stereod.yaml" 2>"$work/stereod.err" &
stereod=$!
children+=("$stereod")

javac -cp "$classpath" -d "$work" "$examples/FrameTimes.java"
java -Djava.net.preferIPv4Stack=true -cp "$classpath:$work" FrameTimes 5 SPY >"$work/java.out" &
java_example=$!
children+=("$java_example")
wait "$java_example" || fail "the Java example ended with an error"
[[ $(grep -c '^frame [0-9]*: [0-9.]* ms$' "$work/java.out") -ge 5 ]] || fail "the Java example printed: $(cat "$work/java.out")"
if python3 -c 'import lcm' 2>/dev/null; then
  PYTHONPATH=$share/python timeout 60 python3 "$examples/frame_times.py" 5 SPY >"$work/python.out"
  [[ $(grep -c '^frame [0-9]*: [0-9.]* ms$' "$work/python.out") -eq 5 ]] || fail "the Python example printed: $(cat "$work/python.out")"
else
  echo "there is no LCM for Python here: its example was not run"
fi

Xvfb -displayfd 3 -screen 0 1340x1000x24 -nolisten tcp 3>"$work/display" 2>"$work/xvfb.err" &
children+=($!)
wait_until test -s "$work/display" || fail "no screen: $(cat "$work/xvfb.err")"
DISPLAY=:$(cat "$work/display")
export DISPLAY

"$bin/stereod-spy" SPY_DISPARITY SPY_STATUS >"$work/spy.out" 2>&1 &
spy=$!
children+=("$spy")
has_window() { xdotool search --name "$1" >/dev/null 2>&1; }
wait_until has_window 'LCM Spy' || fail "no list of channels: $(cat "$work/spy.out")"
wait_until has_window '^SPY_DISPARITY 640x480 [0-9.]+ frames/s [0-9]+ rows lost$' ||
  fail "no picture of the rows: $(cat "$work/spy.out")"
shows_fields() { has_window "^SPY_$1 [0-9.]+ messages/s, 0 ignored\$"; }
wait_until shows_fields STATUS || fail "no window with the fields of the status: $(cat "$work/spy.out")"
! grep -qi exception "$work/spy.out" || fail "$(cat "$work/spy.out")"
if [[ -n $screenshot ]]; then
  sleep 8  # for the charts to have something to show
  import -window root "$screenshot"
fi
kill "$spy"
wait "$spy" || true
echo 'publish: {depth: true, cloud: true}' >>"$work/stereod.yaml"
kill -HUP "$stereod"
"$bin/stereod-spy" SPY_FRAME SPY_SCAN SPY_CAMERA_INFO SPY_DEPTH SPY_CLOUD >"$work/fields.out" 2>&1 &
children+=($!)
for channel in FRAME SCAN CAMERA_INFO DEPTH CLOUD; do
  wait_until shows_fields "$channel" || fail "no window with the fields of SPY_$channel: $(cat "$work/fields.out")"
done
! grep -qi exception "$work/fields.out" || fail "$(cat "$work/fields.out")"
"$bin/stereod-spy" --no-such-option 2>"$work/usage" && fail "an unknown option was taken"
grep -q "unknown option '--no-such-option'" "$work/usage" || fail "$(cat "$work/usage")"
echo "stereod-spy shows what stereod publishes"
