# shows: stereod on two webcams, MJPEG 640x480 at 30/s: pairs, rows over LCM, the cameras' table
# seconds: 150
. /share/guest/lib.sh
start_cameras
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
[[ $(camera_row format) =~ MJPG\ 640×480\ at\ 30/s\ +MJPG\ 640×480\ at\ 30/s ]] || fail "not both give MJPEG at 30/s"
read -r frames_before _ <<<"$(camera_row frames | tr -d ,)"
pairs_before=$(number_of 'pairs made')
start=$(date +%s%N)
received=0
stereo-tap check --seconds 15 | tee check.txt || received=$?
[[ $received -eq 0 ]] || fail "stereo-tap check ended with $received"
get_status
cat status.txt
seconds=$((($(date +%s%N) - start) / 1000000000))
read -r frames_after _ <<<"$(camera_row frames | tr -d ,)"
frames=$((frames_after - frames_before))
pairs=$(($(number_of 'pairs made') - pairs_before))
share=$((100 * pairs / frames))
shown "$frames frames of the left camera in $seconds s, $pairs pairs made ($share %);" \
  "received: $(sed -n 's/^rows  *\([0-9]*\)  *\([0-9]*\).*/\2 of \1 rows/p' check.txt)"
[[ $share -ge 95 ]] || fail "only $share % of the frames found a partner"
[[ $frames -ge $((seconds * 20)) ]] || fail "only $frames frames in $seconds s"
stop_stereod
cat stereod.log
