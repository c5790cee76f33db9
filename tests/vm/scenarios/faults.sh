# shows: ten random faults in a row: each seen in the status, streaming after each, memory and descriptors unchanged
# seconds: 480
. /share/guest/lib.sh
# By itself uvcvideo keeps damaged frames back, and there is nothing to see but a gap in the sequence.
start_cameras nodrop=1
start_stereod "serial:$left_serial" "serial:$right_serial" mjpeg
need_streaming 60

side_number() { if [[ $1 == left ]]; then echo 1; else echo 2; fi; }
# A count of one camera in the latest status.
count_of() { camera_row "$1" | tr -s ' ' | cut -d' ' -f"$(side_number "$2")"; }
risen() { get_status && [[ $(count_of "$1" "$2") -gt $3 ]]; }

# fault KIND SIDE: does it, and waits until the status shows it for what it is.
fault() {
  local kind=$1 side=$2 before
  case $kind in
    unplug)
      tell "$side" unplug
      wait_for 20 says '^  (state|reason) .*(absent|lost|unplugged)' || return 1
      tell "$side" plug
      ;;
    freeze)
      tell "$side" freeze
      wait_for 20 says '^  (state|reason) .*(wedged|silent)' || return 1
      tell "$side" thaw
      ;;
    error)
      get_status && before=$(count_of incomplete "$side")
      tell "$side" "$kind 20"
      wait_for 20 risen incomplete "$side" "$before"
      ;;
    truncate | corrupt | resize)
      get_status && before=$(count_of 'decode errors' "$side")
      tell "$side" "$kind 20"
      wait_for 20 risen 'decode errors' "$side" "$before"
      ;;
  esac
}

# What opens and closes for the first time may allocate; that is not what is measured.
fault unplug left && need_streaming 40
fault unplug right && need_streaming 40
base_descriptors=$(descriptors)
base_memory=$(memory_kb)
# While a camera is looked for, one more is open for a moment.
as_many_descriptors() { [[ $(descriptors) -eq $base_descriptors ]]; }
RANDOM=5
# Each kind once or twice, in a random order.
mapfile -t kinds < <(printf '%s\n' unplug freeze error truncate corrupt resize unplug freeze truncate error |
  shuf --random-source=<(yes 5 2>/dev/null))
for kind in "${kinds[@]}"; do
  if ((RANDOM % 2)); then side=left; else side=right; fi
  echo "=== $kind $side"
  fault "$kind" "$side" || { cat status.txt; tail -n 20 stereod.log; fail "the status does not show: $kind $side"; }
  need_streaming 40 "after $kind $side both cameras should stream"
  echo "descriptors $(descriptors), memory $(memory_kb) kB"
  wait_for 10 as_many_descriptors || { ls -l "/proc/$stereod_pid/fd"; fail "descriptors: $base_descriptors before"; }
done
cat status.txt
grown=$(($(memory_kb) - base_memory))
shown "${kinds[*]}: descriptors $base_descriptors, memory $base_memory kB and $grown kB more"
[[ $grown -lt 1024 ]] || fail "memory grew by $grown kB"
stop_stereod
cat stereod.log
