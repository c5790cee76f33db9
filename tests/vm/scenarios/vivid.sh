# SPDX-License-Identifier: BSD-3-Clause
# shows: the kernel's test driver vivid: every uncompressed format, controls, errors that it injects, lost frames, a disconnect
# seconds: 200
. /share/guest/lib.sh
# Two cameras with one input each, a webcam; their formats in one plane, as stereod reads them.
modprobe vivid n_devs=2 node_types=1,1 num_inputs=1,1 input_types=0,0 multiplanar=1,1 vid_cap_nr=20,21
udevadm settle
left=/dev/video20 right=/dev/video21
fps=10 size=320x180
start() { start_stereod $left $right "$1" "sync: none
    exposure: auto
    controls: { brightness: 90, gain: 60 }"; }

echo "=== timestamps"
# By default vivid delivers a frame before the time of its timestamp.
start gray
need left reason 'timestamped far from now'
need right reason 'timestamped far from now'
v4l2-ctl -d $left -c timestamp_source=1
v4l2-ctl -d $right -c timestamp_source=1
need_streaming 20 "with possible timestamps both cameras should stream"

echo "=== controls"
v4l2-ctl -d $left -C brightness,gain_automatic,gain | tr '\n' ' ' >controls.txt
grep -q '^brightness: 90 gain_automatic: 0 gain: 60 ' controls.txt || fail "the controls are $(cat controls.txt)"
says left note '^-$' || { cat status.txt; fail "the left camera's note should be empty"; }
stop_stereod

echo "=== formats"
shades=
for format in gray nv12 yu12 yuyv uyvy y10 y16; do
  start $format
  need left brightness '^[1-9]'
  need right brightness '^[1-9]'
  shade=$(count_of left brightness)
  # Test bars; some formats have the full range of values and some that of television.
  ((shade > 40 && shade < 220)) || fail "$format has a mean brightness of $shade"
  shades+=" $format $shade,"
  stop_stereod
done
shown "mean brightness:${shades%,}"

echo "=== errors"
start yuyv
need_streaming 20
remember_resources
# fault NAME SENTENCE: injects it, waits until the status says so.
fault() {
  v4l2-ctl -d $left -c "inject_$1=1"
  need left 'last fault' "$2"
  need_recovery "$1"
}
fault fatal_streaming_error 'dequeueing a frame'
fault vidioc_qbuf_error 'queueing a buffer|giving a buffer back'
# An error at the start, after another one that makes it start.
for error in vidioc_reqbufs_error vidioc_streamon_error; do
  v4l2-ctl -d $left -c inject_$error=1 -c inject_fatal_streaming_error=1
  reconnects=$(count_of left reconnects)
  need left reconnects "^$((reconnects + 1))"
  need_recovery "$error"
done
v4l2-ctl -d $left -c inject_v4l2_buf_flag_error=1
need left incomplete '^[1-9]'

echo "=== lost frames"
get_status
before=$(count_of left 'sequence gaps')
v4l2-ctl -d $left -c percentage_of_dropped_buffers=50
more_gaps() { get_status && [[ $(count_of left 'sequence gaps') -gt $((before + 5)) ]]; }
wait_for 20 more_gaps || { cat status.txt; fail "lost frames are not counted"; }
v4l2-ctl -d $left -c percentage_of_dropped_buffers=0

echo "=== disconnect"
v4l2-ctl -d $left -c disconnect=1
need left 'last fault' unplugged  # vivid is back as soon as it is closed
need_recovery disconnect
[[ $(count_of right reconnects) -eq 0 ]] || fail "the right camera was started again, too"
cat status.txt
stop_stereod
cat stereod.log
