# shows: two cameras that start 16 ms apart are brought into phase by restarting one
# seconds: 150
. /share/guest/lib.sh
modprobe vhci-hcd
start_cameras
tell left phase 0
tell right phase 16000
start_stereod "serial:$left_serial" "serial:$right_serial" mjpeg 'align: start
    target_skew_ms: 3
    align_tries: 12'
need_streaming 60
settled() { says 'phase alignment +(aligned|given up|drifted)'; }
wait_for 60 settled || { cat status.txt stereod.log; fail "the alignment comes to no end"; }
cat status.txt stereod.log
shown "$(sed -n 's/^phase alignment  *//p' status.txt); skew median $(number_of '  skew') ms"
grep -qE 'phase alignment +aligned' status.txt || fail "the cameras were not brought into phase"
restarts=$(sed -n 's/.* \([0-9]*\) restarts.*/\1/p' status.txt)
[[ $restarts -ge 1 ]] || fail "they were in phase from the start, so nothing was shown"
stop_stereod
