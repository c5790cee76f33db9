#!/usr/bin/env bash
# Tests with a real kernel: Debian's kernel and systemd in a virtual machine, with webcams on uvcvideo. Each scenario
# gets a freshly booted machine. Says what is skipped where QEMU or the packages cannot be had.
#
#   run.sh [--cpu MODEL] [--bin FOLDER] [--keep] [SCENARIO…]     all scenarios, if none is named
#
# --cpu: a CPU model of QEMU, for example Denverton; --bin: take the programs from there instead of building them;
# --keep: keep the logs of scenarios that pass, too.
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

# Boots a machine for one scenario; succeeds if the scenario did. Its log is in $logs/SCENARIO.
run_scenario() {
  local name=$1 share=$logs/$1 seconds model package
  seconds=$(head_of "$name" seconds)
  model=${cpu:-$(head_of "$name" cpu)}
  rm -rf "$share"
  mkdir -p "$share/bin"
  cp -r "$here/guest" systemd etc "$share"
  # A package that cpack made of these very programs, for scenarios that install it.
  for package in "$bin"/../stereod_*.deb; do
    if [[ $package -nt $bin/stereod ]]; then cp "$package" "$share"; fi
  done
  cp "$here/scenarios/$name.sh" "$share/scenario.sh"
  for program in "${programs[@]}"; do cp "$bin/$program" "$share/bin"; done
  echo "${seconds:-120}" >"$share/seconds"
  timeout -k 5 $((${seconds:-120} + 90)) qemu-system-x86_64 \
    -accel tcg,thread=multi -cpu "${model:-qemu64,+ssse3,+sse4.1,+sse4.2,+popcnt}" -smp 2 -m 1024 -M q35 \
    -nodefaults -display none -no-reboot -serial "file:$share/serial.log" \
    -kernel "$image/vmlinuz" -initrd "$image/initrd.gz" \
    -append "console=ttyS0 quiet loglevel=4 panic=-1 mitigations=off nokaslr root=/dev/vda $kernel_options" \
    -drive "file=$image/rootfs.ext4,if=virtio,format=raw,snapshot=on" \
    -virtfs "local,path=$share,mount_tag=share,security_model=none,id=share" \
    -device virtio-rng-pci >"$share/qemu.log" 2>&1 </dev/null || true
  rm -rf "$share/bin"
  [[ $(cat "$share/status" 2>/dev/null) == 0 ]]
}

# Cameras on the virtual USB controller sometimes do not wake up from autosuspend. The rest makes booting slower and is of
# no use here.
kernel_options="usbcore.autosuspend=-1 systemd.show_status=0 random.trust_cpu=on"
for unit in apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer e2scrub_reap.service \
  fstrim.timer getty.target serial-getty@ttyS0.service systemd-binfmt.service; do
  kernel_options+=" systemd.mask=$unit"
done

cpu=
keep=
built=
scenarios=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --cpu) cpu=${2:?--cpu wants a model} && shift ;;
    --bin) bin=${2:?--bin wants a folder} built=yes && shift ;;
    --keep) keep=yes ;;
    -*) die "usage: tests/vm/run.sh [--cpu MODEL] [--bin FOLDER] [--keep] [SCENARIO…]" ;;
    *) scenarios+=("$1") ;;
  esac
  shift
done
if [[ ${#scenarios[@]} -eq 0 ]]; then
  for file in "$here"/scenarios/*.sh; do scenarios+=("$(basename "$file" .sh)"); done
fi
for name in "${scenarios[@]}"; do
  [[ -f $here/scenarios/$name.sh ]] || die "there is no scenario '$name'; see $here/scenarios"
done

prepared=0
image=$("$here/setup.sh") || prepared=$?
if [[ $prepared -eq 3 ]]; then
  echo "vm/run: SKIPPED: ${scenarios[*]} (no virtual machine can be made here, see above)."
  exit 0
fi
[[ $prepared -eq 0 ]] || die "the image could not be made."
[[ -n $built ]] || build || die "the programs could not be built."

failed=()
for name in "${scenarios[@]}"; do
  started=$SECONDS
  if run_scenario "$name"; then
    printf 'vm/run: %-12s passed in %d s: %s\n' "$name" $((SECONDS - started)) "$(head_of "$name" shows)"
    grep '^shown: ' "$logs/$name/log" | sed 's/^shown: /          /' || true
    [[ -n $keep ]] || rm -rf "${logs:?}/$name"
  else
    failed+=("$name")
    printf 'vm/run: %-12s FAILED after %d s; its end (all of it: %s/%s):\n' "$name" $((SECONDS - started)) "$logs" "$name"
    tail -n 40 "$logs/$name/log" 2>/dev/null || tail -n 20 "$logs/$name/serial.log" || true
  fi
done
if [[ ${#failed[@]} -gt 0 ]]; then
  echo "vm/run: FAILED: ${failed[*]}."
  exit 1
fi
echo "vm/run: passed: ${scenarios[*]}."
