# SPDX-License-Identifier: BSD-3-Clause
# shows: stereod on two webcams, MJPEG 640x480 at 30/s: pairs, rows over LCM, the cameras' table, one exposure for both
# seconds: 200
# alone: yes
. /share/guest/lib.sh
start_cameras
# Timestamps of an emulated machine are some milliseconds off. Half a frame apart, frames would change their partners all the time,
# so the cameras do not start there.
tell left phase 0
tell right phase 2000
# Two streams at full rate are what an emulated processor can just do: little matching beside them.
matcher='preset: fast, disparities: 2, min_disparity: 8, window: 5, prefilter: none, median: 0'
start_stereod "serial:$left_serial" "$(by_path 1)" mjpeg
need_streaming 60
stereod --list-cameras | tee cameras.txt
for word in $left_serial $right_serial mjpeg yuyv 640 platform-vhci_hcd exposure_time_absolute; do
  grep -q "$word" cameras.txt || fail "--list-cameras does not name $word"
done

get_status
cat status.txt
for side in left right; do
  [[ $(of_camera $side format) == "MJPG 640×480 at 30 Hz" ]] || fail "the $side camera does not give MJPEG at 30/s"
done
# Fifteen seconds of it: what each camera gives, what share of the frames is paired, whether every row arrives.
look() {
  local watching received=0
  stereo-tap status >statuses.txt &
  watching=$!
  stereo-tap check --seconds 15 | tee check.txt || received=$?
  kill $watching
  [[ $received -eq 0 ]] || fail "stereo-tap check ended with $received"
  # "  frames  195, 24.4 /s  189, 25.5 /s" and "  pairs made  154  …", once a second.
  read -r left_rate right_rate share < <(awk '
    $1 == "frames" && $4 == "/s" { left += $3; right += $6; if (!n++) before = $2 + $5; after = $2 + $5 }
    $1 == "pairs" && $2 == "made" { if (!m++) pairs_before = $3; pairs_after = $3 }
    END { printf "%.1f %.1f %.1f\n", left / n, right / n, 200 * (pairs_after - pairs_before) / (after - before) }' statuses.txt)
  echo "left $left_rate, right $right_rate frames a second; $share % of the frames paired"
}
reaches() { awk -v value="$1" -v minimum="$2" 'BEGIN { exit !(value >= minimum) }'; }
full_rate() { look && reaches "$left_rate" 29 && reaches "$right_rate" 29 && reaches "$share" 95; }
# On a busy host a camera loses frames that are not fetched in time: the check is repeated a limited number of times.
full_rate || full_rate || full_rate || fail "two cameras are to give 30 frames a second, 95 % of them in pairs"
get_status
cat status.txt
shown "left $left_rate, right $right_rate frames a second; $share % of the frames paired;" \
  "received: $(sed -n 's/^rows  *\([0-9]*\)  *\([0-9]*\).*/\2 of \1 rows/p' check.txt)"

# The left camera's automation makes up for half the light; the right one follows it.
exposure() { v4l2-ctl -d "$(by_id "$1")" -C exposure_time_absolute | sed 's/.* //'; }
tell both light 50
followed() { [[ $(exposure $left_serial) -eq 312 && $(exposure $right_serial) -eq 312 ]]; }
wait_for 20 followed || fail "the exposure is $(exposure $left_serial) on the left and $(exposure $right_serial) on the right"
alike() {
  get_status && awk -v left="$(count_of left brightness)" -v right="$(count_of right brightness)" \
    'BEGIN { exit !(left > 100 && left - right < 10 && right - left < 10) }'
}
wait_for 20 alike || { cat status.txt; fail "the images are not equally bright"; }
stop_stereod
cat stereod.log
