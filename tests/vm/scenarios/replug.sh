# SPDX-License-Identifier: BSD-3-Clause
# shows: unplug left, unplug both, swap ports, freeze 3 s: each reported with its reason, then streaming again without leftovers
# seconds: 240
. /share/guest/lib.sh
start_cameras
size=320x240 start_stereod "$(by_path 0)" "$(by_path 1)" mjpeg
need_streaming 60

echo "=== unplug left"
tell left unplug
need left state 'absent|lost' reason unplugged
need right frames ', [1-9][0-9.]* /s'  # the right camera continues
tell left plug
need_streaming 40 "plugged in again, the left camera should stream"
says left 'last fault' unplugged || fail "the last fault of the left camera should be that it was unplugged"
[[ $(count_of right reconnects) -eq 0 ]] || fail "the right camera was started again, too"
remember_resources

echo "=== unplug both"
tell both unplug
need left reason unplugged
need right reason unplugged
tell both plug
need_recovery "unplugging both"

echo "=== swap ports"
tell both unplug
wait_for 20 test ! -e "$(by_path 0)" || fail "unplugged, the left camera is still there"
wait_for 20 test ! -e "$(by_path 1)" || fail "unplugged, the right camera is still there"
tell left plug 1
tell right plug 0
need_recovery "swapping ports"
[[ $(readlink -f "$(by_id $left_serial)") == $(readlink -f "$(by_path 1)") ]] || fail "the ports are not swapped"
# Left is what is plugged in where left was.
need left device usb-vhci_hcd.0-1
need right device usb-vhci_hcd.0-2

echo "=== freeze for 3 s"
tell right freeze  # it is the left one now
sleep 3
need left state stalled reason 'no frame for'
tell right thaw
need_recovery "the silence"
cat status.txt
shown "reconnects: left $(count_of left reconnects), right $(count_of right reconnects);" \
  "$base_descriptors descriptors and $base_memory kB before, $(descriptors) and $(memory_kb) kB after"
stop_stereod
cat stereod.log
