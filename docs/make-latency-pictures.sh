#!/usr/bin/env bash
# Draws docs/images/frame-life*.svg anew, from build/release: one frame's life, measured. Wants an idle machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [[ ${1:-} != --inside ]]; then exec toolchain/own-network.sh bash docs/make-latency-pictures.sh --inside; fi

bin=build/release/bin
work=$(mktemp -d)
daemon=
clean_up() {
  [[ -z $daemon ]] || kill "$daemon" 2>/dev/null || true
  wait
  rm -rf "$work"
}
trap clean_up EXIT
export LCM_DEFAULT_URL='udpm://239.255.76.67:17674?ttl=0'

# image FILE TITLE SETTINGS
picture() {
  printf 'cameras: {source: synthetic, fps: 30}\n%s\n' "$3" >"$work/stereod.yaml"
  $bin/stereod --config "$work/stereod.yaml" 2>/dev/null &
  daemon=$!
  sleep 2
  $bin/frame_life "docs/images/$1" "$2"
  kill "$daemon"
  wait "$daemon" || true
  daemon=
}
picture frame-life.svg 'The defaults: 640×480, preset robust, two workers, spread 0.3' ''
picture frame-life-early.svg 'Spread 0: rows leave as they are matched' 'lcm: {pacing: 0}'
