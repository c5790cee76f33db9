#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Shows stereod at work: installs its dependencies, builds it, matches a pair of photographs and then a moving rendered
# scene, receives the disparities over LCM, and writes colored depth images to demo-output/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

output=demo-output
daemon_pid=

say() { printf '\n== %s\n' "$*"; }
die() {
  echo "demo: $*" >&2
  exit 1
}

# Stops the daemon by its process id; also when the demo fails or is interrupted.
stop_daemon() {
  local pid=$daemon_pid
  daemon_pid=
  [[ -z $pid ]] && return 0
  kill -TERM "$pid" 2>/dev/null || true
  wait "$pid"
}

# Builds in build/release if it exists, else in build/demo, without tests and OpenCV.
build() {
  local log=$output/build.log dir=build/release
  if [[ ! -f $dir/build.ninja ]]; then
    dir=build/demo
    cmake -S . -B "$dir" -G Ninja -DCMAKE_BUILD_TYPE=Release -DSTEREOD_TESTS=OFF >"$log" 2>&1 ||
      { tail -n 30 "$log" >&2; die "cmake failed; the whole output is in $log."; }
  fi
  say "Building in $dir (a few minutes the first time; log: $log)"
  cmake --build "$dir" --target stereod stereo-tap -j "$(nproc)" >>"$log" 2>&1 ||
    { tail -n 30 "$log" >&2; die "the build failed; the whole output is in $log."; }
  bin=$dir/bin
}

# Chooses the network of the show, prints the reason, and enters it.
enter_network() {
  if toolchain/own-network.sh --possible; then
    say "Network: one of its own (a namespace), so that nothing leaves this machine and no other LCM traffic is disturbed"
    exec toolchain/own-network.sh bash daemon/demo.sh --show "$bin"
  fi
  if ip route get 239.255.76.67 >/dev/null 2>&1; then
    say "Network: this machine's own, because no namespace can be made here; ttl=0 keeps the messages on this machine"
    exec bash daemon/demo.sh --show "$bin"
  fi
  echo "demo: no network namespace can be made here, and no route carries multicast. This makes one within the machine:" >&2
  echo "  sudo ip link set lo up && sudo ip route add 224.0.0.0/4 dev lo" >&2
  exit 1
}

# Prints the path of one of the Aloe photographs of Debian's opencv-doc, unpacked if necessary.
aloe() {
  local file=/usr/share/doc/opencv-doc/examples/data/$1
  if [[ -f $file ]]; then
    echo "$file"
  elif [[ -f $file.gz ]]; then
    gunzip -c "$file.gz" >"$output/$1"
    echo "$PWD/$output/$1"
  else
    return 1
  fi
}

write_aloe_config() {
  cat >"$output/aloe.yaml" <<YAML
# The Aloe photographs (Middlebury 2006), already rectified: replayed as if two cameras saw them.
cameras:
  source: replay
  fps: 10
  replay:
    left: $1
    right: $2
matcher:
  preset: robust
  disparities: 224
YAML
}

# Runs the daemon on configuration $2, receives for a few seconds and keeps an image as demo-output/$1.png.
show() {
  local name=$1 config=$2 scratch=$output/$1-frames log=$output/$1.log
  rm -rf "$scratch"
  "$bin/stereod" --config "$config" --check-config >"$log" 2>&1 || { cat "$log" >&2; die "stereod refuses $config."; }
  "$bin/stereod" --config "$config" >"$log" 2>&1 &
  daemon_pid=$!
  # The first frame takes as long as the images take to load.
  if ! "$bin/stereo-tap" save --frames 1 --out "$scratch" --timeout 60 >/dev/null; then
    cat "$log" >&2
    die "no frame was received from stereod; its output is above."
  fi
  local received=0
  "$bin/stereo-tap" check --seconds 4 || received=$?
  [[ $received -eq 0 || $received -eq 3 ]] || die "stereo-tap check failed."
  echo
  "$bin/stereo-tap" status --once
  rm -rf "$scratch"
  "$bin/stereo-tap" save --frames 1 --out "$scratch" >/dev/null
  mv "$scratch"/*.png "$output/$name.png"
  mv "$scratch"/*.pfm "$output/$name.pfm"
  rmdir "$scratch"
  stop_daemon || { cat "$log" >&2; die "stereod did not stop cleanly; its output is above."; }
  say "Disparity in colors: $PWD/$output/$name.png (in numbers: $output/$name.pfm)"
}

run_show() {
  trap 'stop_daemon || true' EXIT
  # stereo-tap ends cleanly on Ctrl-C, which the shell takes for a reason to go on.
  trap 'exit 130' INT TERM
  # The default for configurations that set no lcm.url.
  export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=0'
  local left right
  if left=$(aloe aloeL.jpg) && right=$(aloe aloeR.jpg); then
    say "Two photographs, 1282 x 1110, 224 disparities ($output/aloe.yaml)"
    write_aloe_config "$left" "$right"
    show aloe "$output/aloe.yaml"
  else
    say "The Aloe photographs (Debian's opencv-doc) are not here: going on without them"
  fi
  say "A rendered scene that moves (etc/demo.yaml)"
  show synthetic etc/demo.yaml
}

case "${1:-}" in
  '')
    mkdir -p "$output"
    toolchain/install-deps.sh
    build
    enter_network
    ;;
  --show)  # the second half, already in its network
    bin=$2
    run_show
    ;;
  *) die "usage: daemon/demo.sh" ;;
esac
