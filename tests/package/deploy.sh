#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# toolchain/deploy.sh, tried against a second machine of the test's own: a bare Debian 12 root with an ssh server on loopback,
# first without systemd, then booted with it, in a network of its own.
# Ends with 77, skipped, without root rights or a tool. Builds the package.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. tests/package/root.sh
if [[ ${1:-} != --inside ]]; then
  need_root ssh ssh-keygen systemd-nspawn
  in_namespace
fi
base machine ca-certificates,openssh-server,sudo,systemd-sysv,dbus
enter machine

# The users there: pilot may use sudo, guest may not.
ssh-keygen -q -t ed25519 -N '' -f "$work/key"
for user in pilot guest; do
  in_root useradd -m -s /bin/bash -p "*" "$user"  # no password, but not locked
  install -d -m 700 "$root/home/$user/.ssh"
  install -m 600 "$work/key.pub" "$root/home/$user/.ssh/authorized_keys"
  in_root chown -R "$user:" "/home/$user/.ssh"
done
echo 'pilot ALL=(ALL) NOPASSWD: ALL' >"$root/etc/sudoers.d/pilot"
# The shell prints a greeting that a shell would expand to all files.
echo "echo '*** Welcome, *'" >"$root/home/pilot/.bashrc"
touch "$root/home/pilot/mine"
mkdir -p "$root/run/sshd"
port=$((20000 + RANDOM % 10000))
in_root /usr/sbin/sshd -D -o ListenAddress=127.0.0.1 -o Port=$port -o UsePAM=no &
server=$!
for _ in {1..50}; do (exec 3<>/dev/tcp/127.0.0.1/$port) 2>/dev/null && break || sleep 0.1; done

# deploy USER PORT [IN…]: its output in $work/out. IN: what runs it elsewhere.
deploy() {
  "${@:3}" toolchain/deploy.sh "$1@127.0.0.1" -p "$2" -i "$work/key" -o StrictHostKeyChecking=no -o UserKnownHostsFile="$work/known" \
    >"$work/out" 2>&1
}
# refused SENTENCE USER [PORT]
refused() {
  ! deploy "$2" "${3:-$port}" || { cat "$work/out"; fail "it should say: $1"; }
  grep -qE "$1" "$work/out" || { cat "$work/out"; fail "it should say: $1"; }
  say "  $(grep -E "$1" "$work/out")"
}
say "sentences on what cannot be:"
refused 'cannot log in at pilot@127.0.0.1 by ssh: .*refused' pilot 1
refused 'cannot log in at nobody@127.0.0.1 by ssh: .*Permission denied' nobody
refused 'neither root nor may use sudo' guest
cp "$root/usr/lib/os-release" "$work/os-release"
sed -i 's/^VERSION_ID=.*/VERSION_ID="11"/' "$root/usr/lib/os-release"
refused 'runs debian 11, but the package is made for Debian 12' pilot
cp "$work/os-release" "$root/usr/lib/os-release"
printf '#!/bin/sh\necho riscv64\n' >"$root/usr/local/bin/dpkg" && chmod 755 "$root/usr/local/bin/dpkg"
refused 'of the architecture riscv64; packages are made for amd64' pilot
rm "$root/usr/local/bin/dpkg"

say "installs, without systemd"
deploy pilot "$port" || { cat "$work/out"; fail "deploy.sh ended with an error"; }
in_root stereod --version || fail "stereod was not installed"
[[ -e $root/home/pilot/mine && ! -e $root/home/pilot/Welcome, ]] || fail "it has touched what is pilot's own"
grep -q 'systemd does not run' "$work/out" || { cat "$work/out"; fail "it should say that no systemd runs"; }

say "the same machine with systemd: installs again, starts, shows status and journal"
kill "$server"
rm -rf "$root/run/sshd"
boot
property() { in_booted systemctl show --property "$1" --value stereod.service; }
echo '# my own line' >>"$root/etc/stereod/stereod.yaml"
deploy pilot 22 in_its_network || { cat "$work/out"; fail "deploy.sh ended with an error"; }
for sentence in 'Active: active \(running\)' 'Status: "waiting for cameras: ' 'state: waiting' 'but not after the next start of' 'deploy: done'; do
  grep -qE "$sentence" "$work/out" || { cat "$work/out"; fail "it should show '$sentence'"; }
done
say "  $(grep -o 'Status: .*' "$work/out")"
[[ $(grep 'Status: ' "$work/out" | grep -o 'needs two cameras' | wc -l) -eq 1 ]] || fail "the reason that both cameras share must be printed once"
grep -q '^# my own line$' "$root/etc/stereod/stereod.yaml" || fail "it has overwritten the configuration"
[[ -z $(in_booted find /tmp -maxdepth 1 -name 'stereod-*') ]] || fail "the package was left in /tmp"

say "over the running service"
pid=$(property MainPID)
in_booted systemctl --quiet enable stereod
deploy pilot 22 in_its_network || { cat "$work/out"; fail "deploy.sh ended with an error"; }
[[ $(property MainPID) -ne $pid && $(property ActiveState) == active ]] || fail "it was not restarted"
! grep -q 'not after the next start' "$work/out" || fail "it is enabled, and deploy.sh says it is not"

say "a robot whose pairs have instances: they are restarted, and no other service takes their cameras"
in_booted systemctl --quiet disable --now stereod
printf 'cameras: {source: synthetic, fps: 5}\nlcm: {prefix: FRONT}\n' >"$root/etc/stereod/front.yaml"
in_booted systemctl --quiet enable --now stereod@front
front() { in_booted systemctl show --property "$1" --value stereod@front.service; }
pid=$(front MainPID)
deploy pilot 22 in_its_network || { cat "$work/out"; fail "deploy.sh ended with an error"; }
[[ $(front MainPID) -ne $pid && $(front ActiveState) == active ]] || fail "stereod@front was not restarted"
[[ $(property ActiveState) == inactive ]] || fail "stereod was started beside stereod@front"
grep -q 'stereod@front.service' "$work/out" || { cat "$work/out"; fail "it should show stereod@front"; }
in_booted systemctl --quiet disable --now stereod@front
in_booted systemctl --quiet enable --now stereod

say "a configuration that can never work"
echo 'matchr: {}' >>"$root/etc/stereod/stereod.yaml"
! deploy pilot 22 in_its_network || { cat "$work/out"; fail "deploy.sh should end with an error"; }
for sentence in "matchr: is not a known key; the nearest known key is 'matcher'" 'status=78' 'deploy: stereod does not start on'; do
  grep -qE "$sentence" "$work/out" || { cat "$work/out"; fail "it should show '$sentence'"; }
done
say "  $(grep -o "matchr: .*" "$work/out" | head -n 1)"
say "passed."
