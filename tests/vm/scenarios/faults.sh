# shows: ten random faults in a row: each seen in the status, streaming after each, memory and descriptors unchanged
# seconds: 300
. /share/guest/lib.sh
# By itself uvcvideo keeps damaged frames back, and there is nothing to see but a gap in the sequence.
start_cameras nodrop=1
size=320x240 start_stereod "serial:$left_serial" "serial:$right_serial" mjpeg
need_streaming 60

risen() { get_status && [[ $(count_of "$1" "$2") -gt $3 ]]; }
# The camera sends 20 frames with this damage; the status counts them in this row.
damage() {
  local kind=$1 side=$2 row=$3 before
  get_status
  before=$(count_of "$side" "$row")
  tell "$side" "$kind 20"
  wait_for 20 risen "$side" "$row" "$before" || { cat status.txt; fail "$kind $side: '$row' does not rise"; }
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

fault unplug left && need_streaming 40
fault unplug right && need_streaming 40
remember_resources
RANDOM=5
mapfile -t kinds < <(printf '%s\n' unplug freeze refuse error truncate corrupt resize unplug freeze error |
  shuf --random-source=<(yes 5 2>/dev/null))
done_so_far=
for kind in "${kinds[@]}"; do
  if ((RANDOM % 2)); then side=left; else side=right; fi
  echo "=== $kind $side"
  fault "$kind" "$side"
  need_recovery "$kind $side"
  done_so_far+="$kind $side, "
done
cat status.txt
shown "${done_so_far%, }: descriptors $base_descriptors, memory $base_memory kB and $grown kB more"
stop_stereod
cat stereod.log
