#!/usr/bin/env bash
# toolchain/deploy.sh, tried against a second machine of the test's own: a bare Debian 12 root with an ssh server, which
# listens on loopback only. Its systemctl and journalctl only write down how they were called, as no systemd runs there.
# Ends with 77, skipped, for who is not root or lacks a tool. Builds the package (preset package), if it is not there.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."

say() { echo "deploy test: $*"; }
fail() {
  echo "deploy test: FAILED: $*" >&2
  exit 1
}
if [[ ${1:-} != --inside ]]; then
  [[ $(id -u) -eq 0 ]] || { say "roots are made by root: skipped." && exit 77; }
  for tool in mmdebstrap ssh ssh-keygen; do
    command -v $tool >/dev/null || { say "no $tool here (toolchain/install-deps.sh --packages): skipped." && exit 77; }
  done
  work=$(mktemp -d)
  status=0
  unshare --mount --pid --fork --kill-child bash "$here/$(basename "${BASH_SOURCE[0]}")" --inside "$work" || status=$?
  rm -rf --one-file-system "$work"  # what was mounted there has gone with the namespace
  exit "$status"
fi
work=$2
. "$here/root.sh"
base host ca-certificates,openssh-server,sudo
enter host

# The users there: pilot may use sudo, guest may not.
ssh-keygen -q -t ed25519 -N '' -f "$work/key"
for user in pilot guest; do
  in_root useradd -m -s /bin/bash -p "*" "$user"  # no password, but not locked
  install -d -m 700 "$root/home/$user/.ssh"
  install -m 600 "$work/key.pub" "$root/home/$user/.ssh/authorized_keys"
  in_root chown -R "$user:" "/home/$user/.ssh"
done
echo 'pilot ALL=(ALL) NOPASSWD: ALL' >"$root/etc/sudoers.d/pilot"
for program in systemctl journalctl; do
  printf '#!/bin/sh\necho "%s $*" | tee -a /tmp/calls\n[ "$2" != is-enabled ]\n' "$program" >"$root/usr/local/bin/$program"
  chmod 755 "$root/usr/local/bin/$program"
done
install -m 666 /dev/null "$root/tmp/calls"
mkdir -p "$root/run/sshd"
port=$((20000 + RANDOM % 10000))
in_root /usr/sbin/sshd -D -o ListenAddress=127.0.0.1 -o Port=$port -o UsePAM=no &
for _ in {1..50}; do (exec 3<>/dev/tcp/127.0.0.1/$port) 2>/dev/null && break || sleep 0.1; done

# deploy USER PORT: its output in $work/out.
deploy() {
  toolchain/deploy.sh "$1@127.0.0.1" -p "$2" -i "$work/key" -o StrictHostKeyChecking=no -o UserKnownHostsFile="$work/known" \
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
grep -q 'systemd does not run' "$work/out" || { cat "$work/out"; fail "it should say that no systemd runs"; }

say "installs again, restarts, shows status and journal"
echo '# my own line' >>"$root/etc/stereod/stereod.yaml"
mkdir -p "$root/run/systemd/system"
deploy pilot "$port" || { cat "$work/out"; fail "deploy.sh ended with an error"; }
for call in 'systemctl restart stereod' 'systemctl --no-pager --full status stereod' 'journalctl --no-pager -o cat -u stereod'; do
  grep -qF "$call" "$root/tmp/calls" || { cat "$root/tmp/calls"; fail "it did not call '$call'"; }
  grep -qF "$call" "$work/out" || [[ $call == *restart* ]] || fail "what '$call' said was not shown"
done
grep -q '^# my own line$' "$root/etc/stereod/stereod.yaml" || fail "it has overwritten the configuration"
[[ -z $(compgen -G "$root/tmp/stereod-*") ]] || fail "the package was left in /tmp"
say "passed."
