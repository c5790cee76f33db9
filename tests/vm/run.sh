#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests with a real kernel: Debian's kernel and systemd in a virtual machine, with webcams on uvcvideo. All scenarios run in
# one machine, one after the other. Says what is skipped where QEMU or the packages cannot be had.
#
#   run.sh [--cpu MODEL] [--bin DIRECTORY] [--package FILE] [--seed N] [--pause GROUP] [SCENARIO…]     default: all scenarios
#
# --cpu: a CPU model of QEMU, for example Denverton; --bin: take the programs from there instead of building them; --package: the
# stereod that is installed by the scenarios that install it; --seed: of what scenarios do at random, as an earlier run printed it;
# --pause: a process group that stands still while a scenario runs whose head says that it wants the CPUs for itself.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
here=tests/vm
logs=build/vm
bin=build/release/bin
programs=(stereod stereo-tap stereo-match uvcsim loopback-feed)

die() {
  echo "vm/run: $*" >&2
  exit 1
}

build() {
  cmake --preset release >/dev/null &&
    cmake --build --preset release -j "$(nproc)" --target "${programs[@]}" >/dev/null
}

# A line of a scenario's head, "# NAME: VALUE".
head_of() { sed -n "s/^# $2: *//p" "$here/scenarios/$1.sh" | head -n 1; }

# What the machine finds in /share. It leaves the log of each scenario there.
fill_share() {
  local name program
  rm -rf "$logs"
  mkdir -p "$logs/bin"
  echo "$seed" >"$logs/seed"
  cp -r "$here/guest" systemd etc "$logs"
  for program in "${programs[@]}"; do cp "$bin/$program" "$logs/bin"; done
  [[ -z $package ]] || cp "$package" "$logs"
  for name in "${scenarios[@]}"; do
    mkdir "$logs/$name"
    cp "$here/scenarios/$name.sh" "$logs/$name/scenario.sh"
    head_of "$name" seconds >"$logs/$name/seconds"
    echo "$name" >>"$logs/order"
  done
}

# Boots the machine in the background: boot SECONDS, after which it is killed.
boot() {
  timeout -k 5 "$1" qemu-system-x86_64 \
    -accel tcg,thread=multi -cpu "$cpu" -smp 2 -m 1024 -M q35 \
    -nodefaults -display none -no-reboot -serial "file:$logs/serial.log" \
    -kernel "$image/vmlinuz" -initrd "$image/initrd.gz" \
    -append "console=ttyS0 quiet loglevel=4 panic=-1 mitigations=off nokaslr root=/dev/vda $kernel_options" \
    -drive "file=$image/rootfs.ext4,if=virtio,format=raw,snapshot=on" \
    -virtfs "local,path=$logs,mount_tag=share,security_model=none,id=share" \
    -device virtio-rng-pci >"$logs/qemu.log" 2>&1 </dev/null &
  machine=$!
}

# Stops the process group of --pause while a scenario wants to be alone, and lets it go on.
neighbor() {
  if [[ -n $pause && $(head_of "$2" alone) == yes ]]; then kill -"$1" -- -"$pause" 2>/dev/null || true; fi
}

# Waits for the end of a scenario or of the machine, and prints the result.
report() {
  local name=$1 status= seconds=
  while [[ ! -f $logs/$name/result ]] && kill -0 "$machine" 2>/dev/null; do sleep 0.5; done
  [[ ! -f $logs/$name/result ]] || read -r status seconds <"$logs/$name/result"
  if [[ $status == 0 ]]; then
    printf 'vm/run: %-10s passed in %d s: %s\n' "$name" "$seconds" "$(head_of "$name" shows)"
    sed -n 's/^shown: /          /p' "$logs/$name/log"
    return 0
  fi
  printf 'vm/run: %-10s FAILED; its end (all of it: %s/%s):\n' "$name" "$logs" "$name"
  tail -q -n 40 "$logs/$name/log" 2>/dev/null || tail -q -n 20 "$logs/serial.log" "$logs/qemu.log" || true
  return 1
}

# Cameras on the virtual USB controller sometimes do not wake up from autosuspend. The rest makes booting slower and is of
# no use here.
kernel_options="usbcore.autosuspend=-1 systemd.show_status=0 random.trust_cpu=on"
for unit in apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer e2scrub_reap.service \
  fstrim.timer getty.target serial-getty@ttyS0.service systemd-binfmt.service; do
  kernel_options+=" systemd.mask=$unit"
done

cpu=Denverton  # an Atom: SSE4.2, no AVX
built=
package=
seed=$RANDOM  # another each time
pause=
scenarios=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --cpu) cpu=${2:?--cpu wants a model} && shift ;;
    --bin) bin=${2:?--bin wants a directory} built=yes && shift ;;
    --package) package=$(realpath "${2:?--package wants a file}") && shift ;;
    --seed) seed=${2:?--seed wants a number} && shift ;;
    --pause) pause=${2:?--pause wants a process group} && shift ;;
    -*) die "usage: tests/vm/run.sh [--cpu MODEL] [--bin DIRECTORY] [--package FILE] [--seed N] [--pause GROUP] [SCENARIO…]" ;;
    *) scenarios+=("$1") ;;
  esac
  shift
done
if [[ ${#scenarios[@]} -eq 0 ]]; then
  for file in "$here"/scenarios/*.sh; do scenarios+=("$(basename "$file" .sh)"); done
fi
allowed=60  # s; for booting and for what is between the scenarios
for name in "${scenarios[@]}"; do
  [[ -f $here/scenarios/$name.sh ]] || die "there is no scenario '$name'; see $here/scenarios"
  allowed=$((allowed + $(head_of "$name" seconds)))
done

# A package that cpack made of these very programs, if the caller named no other.
if [[ -z $package ]]; then
  for made in "$bin"/../stereod_*_amd64.deb; do
    if [[ $made -nt $bin/stereod ]]; then package=$made; fi
  done
fi
kept=()
for name in "${scenarios[@]}"; do
  if [[ $(head_of "$name" needs) == package && -z $package ]]; then
    echo "vm/run: SKIPPED: $name (no package of stereod here: --package FILE, or cpack --preset release)."
  else
    kept+=("$name")
  fi
done
scenarios=("${kept[@]}")
[[ ${#scenarios[@]} -gt 0 ]] || exit 0

prepared=0
image=$("$here/setup.sh") || prepared=$?
if [[ $prepared -eq 3 ]]; then
  echo "vm/run: SKIPPED: ${scenarios[*]} (no virtual machine can be made here, see above)."
  exit 0
fi
[[ $prepared -eq 0 ]] || die "the image could not be made."
[[ -n $built ]] || build || die "the programs could not be built."

# Runs $scenarios in a freshly booted machine; leaves in $failed those that did not pass.
run_all() {
  local name
  fill_share
  boot "$allowed"
  trap 'kill "$machine" 2>/dev/null || true; [[ -z $pause ]] || kill -CONT -- -"$pause" 2>/dev/null || true' EXIT
  failed=()
  for name in "${scenarios[@]}"; do
    neighbor STOP "$name"
    report "$name" || failed+=("$name")
    neighbor CONT "$name"
  done
  wait "$machine" || true
  trap - EXIT
  rm -rf "${logs:?}/bin"
}

asked=("${scenarios[@]}")
run_all
# No program may crash a kernel, so that is no verdict on ours: the unplugged camera's last close does it now and then.
if [[ ${#failed[@]} -gt 0 ]] && grep -q 'BUG: kernel' "$logs/serial.log"; then
  echo "vm/run: the machine's kernel has crashed; once more in a fresh one: ${failed[*]}"
  scenarios=("${failed[@]}")
  run_all
fi
if [[ ${#failed[@]} -gt 0 ]]; then
  echo "vm/run: FAILED: ${failed[*]}."
  exit 1
fi
echo "vm/run: passed: ${asked[*]}."
