#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the screenshots in docs/images from build/release: stereo-view in headless Chromium, stereod-spy on a virtual screen,
# and the output of stereo-tap. Needs the Debian packages chromium, xvfb, xdotool, imagemagick, fonts-dejavu-core and those of
# stereod-spy, and an idle machine for some minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [[ ${1:-} != --inside ]]; then exec toolchain/own-network.sh bash docs/make-screenshots.sh --inside; fi

bin=build/release/bin
work=$(mktemp -d)
children=()
clean_up() {
  local child
  for child in "${children[@]}"; do kill "$child" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT

# keep FILE NAME: reduces an image to 64 colors and 1000 px width, enough to read it.
keep() { convert "$1" -resize '1000x>' -colors 64 -strip "PNG8:docs/images/$2"; }

STEREO_SCREENSHOTS=$work $bin/test_view --gtest_filter='Browser.Stream_ShownAsOnTheWire'
keep "$work/stereo-view.png" stereo-view.png

tests/daemon/tools/spy/run.sh "$bin" build/release/share/stereod "$work/stereod-spy.png"
keep "$work/stereod-spy.png" stereod-spy.png

export LCM_DEFAULT_URL='udpm://239.255.76.67:17670?ttl=0'
$bin/stereod --config etc/demo.yaml 2>/dev/null &
children+=($!)
sleep 10
# Draws the terminal's text, because no terminal emulator runs in a network namespace of its own.
status=$($bin/stereo-tap status --once | sed 's/\\/\\\\/g; s/%/%%/g')  # % is convert's own
convert -size 760x640 xc:'#14171c' -fill '#e8ebef' -font DejaVu-Sans-Mono -pointsize 15 -annotate +14+26 "$status" \
  "$work/stereo-tap.png"
keep "$work/stereo-tap.png" stereo-tap.png
