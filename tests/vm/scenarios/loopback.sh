# SPDX-License-Identifier: BSD-3-Clause
# shows: YUYV through v4l2loopback: rows byte-identical to stereo-match on the same pairs; RGB through libv4l2's conversion
# seconds: 120
. /share/guest/lib.sh
# The module has two buffers unless told otherwise, and writes into the one that a reader still holds: enough of them, and
# a rate at which none comes round again while it is being matched.
modprobe v4l2loopback devices=4 video_nr=10,11,12,13 exclusive_caps=1,1,1,1 max_buffers=8
udevadm settle
mkdir pairs saved
loopback-feed --left /dev/video10 --right /dev/video11 --pairs pairs --fps 2 &
feed=$!
wait_for 20 test -e pairs/pair-7-right.pgm || fail "the feed has made no pairs"
fps=10 start_stereod /dev/video10 /dev/video11 yuyv
need_streaming 60
stereo-tap save --frames 6 --out saved || fail "no frames were received"
get_status
cat status.txt
stop_stereod

declare -A pair_of
for number in {0..7}; do
  stereo-match --config stereod.yaml -o "pairs/$number.pfm" "pairs/pair-$number-left.pgm" "pairs/pair-$number-right.pgm"
  pair_of[$(sha256sum <"pairs/$number.pfm")]=$number
done
[[ ${#pair_of[@]} -eq 8 ]] || fail "the eight pairs give only ${#pair_of[@]} different disparities"
identical=
for frame in saved/*.pfm; do
  number=${pair_of[$(sha256sum <"$frame")]:-}
  [[ -n $number ]] || fail "$frame is the disparity of none of the pairs"
  identical+=" $number"
done
[[ $(tr ' ' '\n' <<<"$identical" | sort -u | wc -l) -gt 2 ]] || fail "always the same pair:$identical"
shown "six frames received, byte for byte those of pairs$identical"

# What stereod does not read itself goes through libv4l2.
kill $feed
wait $feed || true
loopback-feed --left /dev/video12 --right /dev/video13 --pairs pairs --fps 5 --rgb &
offers_rgb() { v4l2-ctl -d "$1" --list-formats | grep -q RGB3; }
wait_for 20 offers_rgb /dev/video13 || fail "the right device does not offer RGB"
fps=10 start_stereod /dev/video12 /dev/video13 auto
need left format 'converted by libv4l2'
need right format 'converted by libv4l2'
need left brightness '^1[0-3][0-9]'  # 124 in the narrower range of television: 122
need_streaming 20
get_status
cat status.txt
shown "converted: $(of_camera left format), brightness $(of_camera left brightness)"
stop_stereod
