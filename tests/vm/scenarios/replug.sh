# shows: unplug left, unplug both, swap ports, freeze 3 s: said with its reason, and streaming again
# seconds: 240
. /share/guest/lib.sh
start_cameras
start_stereod "$(by_path 0)" "$(by_path 1)" mjpeg
need_streaming 60

row_says() { get_status && [[ $(whole_row "$1") =~ $2 ]]; }

echo "=== unplug left"
tell left unplug
wait_for 20 row_says state 'absent|lost' || { cat status.txt; fail "nobody noticed that the left camera was unplugged"; }
wait_for 10 says '/s now  +[0-9]+, [1-9]' || { cat status.txt; fail "the right camera stopped, too"; }
tell left plug
need_streaming 40 "plugged in again, the left camera should stream"
row_says 'last fault' unplugged || { cat status.txt; fail "the last fault should be that it was unplugged"; }

echo "=== unplug both"
tell both unplug
wait_for 20 says '^  state  *(absent|lost)  *(absent|lost)' || { cat status.txt; fail "both should be absent"; }
sleep 2
tell both plug
need_streaming 40 "plugged in again, both cameras should stream"

echo "=== swap ports"
tell both unplug
wait_for 20 test ! -e "$(by_path 0)"
wait_for 20 test ! -e "$(by_path 1)"
tell left plug 1
tell right plug 0
need_streaming 40 "with swapped ports both cameras should stream"
[[ $(readlink -f "$(by_id $left_serial)") == $(readlink -f "$(by_path 1)") ]] || fail "the ports are not swapped"
cat status.txt

echo "=== freeze 3 s"
tell right freeze
sleep 3
wait_for 10 row_says state wedged || { cat status.txt; fail "nobody noticed that the right camera is silent"; }
cat status.txt
tell right thaw
need_streaming 40 "after the silence both cameras should stream"
cat status.txt

reconnects=$(camera_row reconnects | tr -s ' ')
shown "reconnects of left and right: $reconnects"
stop_stereod
cat stereod.log
