#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws docs/images/frame-life*.svg from build/release: one frame's life, measured. Needs an idle machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [[ ${1:-} != --inside ]]; then exec toolchain/own-network.sh bash docs/make-latency-images.sh --inside; fi

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

# draw FILE TITLE SETTINGS
draw() {
  printf 'cameras: {source: synthetic, fps: 30}\n%s\n' "$3" >"$work/stereod.yaml"
  $bin/stereod --config "$work/stereod.yaml" 2>/dev/null &
  daemon=$!
  sleep 2
  $bin/frame_life "docs/images/$1" "$2"
  kill "$daemon"
  wait "$daemon" || true
  daemon=
}
draw frame-life.svg 'Defaults: 640×480, preset robust, two workers, pacing 0.3' ''
draw frame-life-early.svg 'Pacing 0: rows leave as they are matched' 'lcm: {pacing: 0}'
