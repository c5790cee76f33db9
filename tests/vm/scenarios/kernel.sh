# SPDX-License-Identifier: BSD-3-Clause
# shows: the simulated cameras are webcams to uvcvideo: names, formats, controls, frames, exposure
# seconds: 120
. /share/guest/lib.sh
start_cameras
left=$(by_id $left_serial)
ls -l /dev/v4l/by-id /dev/v4l/by-path
v4l2-ctl -d "$left" --all --list-formats-ext >all.txt
cat all.txt
for word in "'YUYV'" "'MJPG'" "640x480" "320x240" "30.000 fps" "10.000 fps" exposure_time_absolute gain power_line_frequency \
  white_balance_temperature; do
  grep -q "$word" all.txt || fail "the left camera lacks $word"
done
[[ -e $(by_path 0) && -e $(by_path 1) ]] || fail "the names by port are missing"

# Prints how many frames came and the mean brightness of the last one.
capture() {  # FORMAT FRAMES
  timeout 40 v4l2-ctl -d "$left" --set-fmt-video="width=640,height=480,pixelformat=$1" --stream-mmap --stream-count="$2" \
    --stream-to=frames.raw >capture.txt 2>&1 || { cat capture.txt; fail "no $2 frames in $1"; }
}
capture MJPG 60
capture YUYV 20
[[ $(stat -c %s frames.raw) -eq $((20 * 640 * 480 * 2)) ]] || fail "YUYV frames are not whole"
mean_of_yuyv() { tail -c 614400 frames.raw | od -An -v -tu1 -w2 | awk '{ s += $1 } END { printf "%d", s / NR }'; }
normal=$(mean_of_yuyv)

v4l2-ctl -d "$left" -c exposure_time_absolute=40 2>/dev/null && fail "the exposure time was set though it is automatic"
v4l2-ctl -d "$left" -c auto_exposure=1
v4l2-ctl -d "$left" -c exposure_time_absolute=39
capture YUYV 20
dark=$(mean_of_yuyv)
v4l2-ctl -d "$left" -c gain=64
capture YUYV 20
lighter=$(mean_of_yuyv)
shown "mean brightness $normal; a quarter of the exposure time $dark; twice the gain $lighter"
((dark * 3 < normal && lighter * 3 > dark * 5 && lighter < normal)) || fail "exposure and gain have no effect"

tell left unplug
wait_for 10 test ! -e "$left" || fail "unplugged, it is still there"
tell left plug
wait_for 20 test -e "$left" || fail "plugged in again, it does not come back"
