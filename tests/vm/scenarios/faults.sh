# SPDX-License-Identifier: BSD-3-Clause
# shows: ten random faults in a row: each seen in the status, streaming after each, memory and descriptors unchanged
# seconds: 500
. /share/guest/lib.sh
# By itself uvcvideo keeps damaged frames back, and there is nothing to see but a gap in the sequence.
start_cameras nodrop=1
size=320x240 start_stereod "serial:$left_serial" "serial:$right_serial" mjpeg
need_streaming 60

damage_rows=(incomplete 'decode errors')
counted() { get_status && [[ $(count_of "$1" "$2") -ge $3 ]]; }
# The camera sends 20 frames with this damage. Those that arrive (on a starved machine the driver lacks a buffer now and then) are
# counted in this row, once, and none in another.
damage() {
  local kind=$1 side=$2 row=$3 other
  local -A before
  get_status
  for other in "${damage_rows[@]}"; do before[$other]=$(count_of "$side" "$other"); done
  tell "$side" "$kind 20"
  wait_for 20 counted "$side" "$row" $((before[$row] + 10)) || { cat status.txt; fail "$kind $side: '$row' does not rise by 10"; }
  sleep 2
  get_status
  for other in "${damage_rows[@]}"; do
    [[ $other == "$row" ]] || [[ $(count_of "$side" "$other") -eq ${before[$other]} ]] ||
      { cat status.txt; fail "$kind $side: '$other' rises too"; }
  done
  [[ $(count_of "$side" "$row") -le $((before[$row] + 20)) ]] || { cat status.txt; fail "$kind $side: '$row' rises by more than 20"; }
}

# fault KIND SIDE: does it, and waits until the status shows it for what it is.
fault() {
  local kind=$1 side=$2
  case $kind in
    unplug)
      tell "$side" unplug
      need "$side" state 'absent|lost' reason unplugged
      tell "$side" plug
      ;;
    freeze)
      tell "$side" freeze
      need "$side" state wedged reason 'fallen silent'
      tell "$side" thaw
      ;;
    refuse)
      tell "$side" refuse 1
      tell "$side" unplug
      need "$side" reason unplugged
      tell "$side" plug
      need "$side" reason 'starting the stream'
      tell "$side" refuse 0
      ;;
    error) damage error "$side" incomplete ;;
    truncate | corrupt | resize) damage "$kind" "$side" 'decode errors' ;;
  esac
}

# Each kind once first, so that what is allocated once has been.
side=left
for kind in unplug freeze refuse error truncate corrupt resize unplug; do
  fault "$kind" "$side" && need_streaming 40
  if [[ $side == left ]]; then side=right; else side=left; fi
done
remember_resources
seed=$(cat /share/seed)
echo "seed $seed"
RANDOM=$seed
mapfile -t kinds < <(printf '%s\n' unplug freeze refuse error truncate corrupt resize unplug freeze error |
  shuf --random-source=<(yes "$seed" 2>/dev/null))
done_so_far=
for kind in "${kinds[@]}"; do
  if ((RANDOM % 2)); then side=left; else side=right; fi
  echo "=== $kind $side"
  fault "$kind" "$side"
  need_recovery "$kind $side"
  done_so_far+="$kind $side, "
done
cat status.txt
shown "seed $seed: ${done_so_far%, }: descriptors $base_descriptors, memory $base_memory kB and $grown kB more"
stop_stereod
cat stereod.log
