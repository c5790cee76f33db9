#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# docs/from-bare-board.md, word for word: the commands are taken from the page itself. The board is a bare Debian 12 root
# with an ssh server and your key, booted with systemd in a network of its own; the developer's machine is this one.
# A root has no cameras: in their place the editor that the page calls writes down a rendered scene. With cameras the
# service is tried in the virtual machine (tests/vm).
# Ends with 77, skipped, without root rights or a tool. Builds the packages.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. tests/package/root.sh
page=docs/from-bare-board.md
if [[ ${1:-} != --inside ]]; then
  need_root ssh scp ssh-keygen systemd-nspawn
  in_namespace
fi

# block HEADING N: the Nth block of commands under a heading.
block() {
  awk -v heading="## $1" -v wanted="$2" '
    /^## / { here = $0 == heading; count = 0; next }
    /^    / { if (!inside) ++count; inside = 1; if (here && count == wanted) print substr($0, 5); next }
    { inside = 0 }' "$page"
}

# What a user types at home. The board's network leads nowhere else, so there only what names the board.
at_home() {
  local line
  while read -r line; do
    case $line in
      *BOARD*) in_its_network bash -ec "$line" ;;
      *) bash -ec "$line" ;;
    esac </dev/null || return 1
  done <<<"$1" >"$work/out" 2>&1
}
# And at the board, by ssh: he answers questions with yes, and ends what would show something for ever with Ctrl-C.
at_board() {
  in_its_network ssh root@BOARD 'set -e; stereo-tap() { timeout --preserve-status -s INT 10 /usr/bin/stereo-tap "$@"; }'"
$1" < <(yes) >"$work/out" 2>&1
}
# follow WHERE HEADING N [AFTERWARDS]: runs a block; what it says is in $work/out.
followed=0
follow() {
  local commands
  commands=$(block "$2" "$3")
  [[ -n $commands ]] || fail "$page has no block $3 of commands under '$2'"
  followed=$((followed + 1))
  say "$2"
  sed 's/^/    /' <<<"$commands"
  "$1" "$commands"$'\n'"${4:-}" || { cat "$work/out"; fail "'$2', block $3, ends with an error"; }
}
shows() {
  grep -qE "$1" "$work/out" || { cat "$work/out"; fail "it should show '$1'"; }
  say "  $(grep -E "$1" "$work/out" | head -n 1 | sed 's/^ *//')"
}

# new_board: boots a bare board. What apt will fetch there is fetched before.
new_board() {
  enter machine
  in_root apt-get -qq -y --no-install-recommends --download-only install "/debs/$package" >"$work/apt.log" 2>&1 ||
    { cat "$work/apt.log"; fail "apt cannot fetch what stereod needs"; }
  umount "$root/debs"
  install -d -m 700 "$root/root/.ssh"
  install -m 600 "$work/ssh/id_ed25519.pub" "$root/root/.ssh/authorized_keys"
  printf '%s\n' '#!/bin/sh' 'echo "cameras: {source: synthetic}" >"$1"' >"$root/usr/local/bin/editor"
  chmod 755 "$root/usr/local/bin/editor"
  boot
}
streams() {
  local tries
  for tries in {1..100}; do
    [[ ! $(in_booted systemctl show --property StatusText --value stereod) =~ ^streaming ]] || return 0
    sleep 0.2
  done
  in_booted systemctl --no-pager status stereod || true
  fail "it does not stream"
}

say "the packages"
{ cmake --preset package && cmake --build --preset package -j "${JOBS:-$(nproc)}" && rm -f build/package/*.deb &&
  cpack --preset package; } >"$work/build.log" 2>&1 || { tail -n 30 "$work/build.log"; fail "the packages could not be made"; }
debs=$(realpath build/package)
package=$(basename build/package/stereod_*.deb)

# The name BOARD, and a key: known here to this test alone.
mkdir -p -m 700 "$work/ssh" ~/.ssh
ssh-keygen -q -t ed25519 -N '' -f "$work/ssh/id_ed25519"
echo 'StrictHostKeyChecking accept-new' >"$work/ssh/config"
{ cat /etc/hosts && echo 127.0.0.1 BOARD; } >"$work/hosts"
mount --bind "$work/hosts" /etc/hosts
mount --bind "$work/ssh" ~/.ssh

base machine ca-certificates,openssh-server,sudo,systemd-sysv,dbus
new_board
follow at_home "1. From the developer's machine" 1
shows 'Active: active \(running\)'
shows 'Status: "waiting for cameras: '
shows '^deploy: done'
follow at_board "2. On the board" 1
shows '^There is no camera'
streams
follow at_board "3. Rows" 1
shows 'Status: "streaming: [0-9.]+ fps'
shows '^rows +[1-9][0-9]* +[1-9]'
shows '^state +streaming'

# Another bare one.
in_booted systemctl poweroff || true
wait
umount -R "$root"
rmdir "$root"
new_board
follow at_home "Without cameras" 1
follow at_board "Without cameras" 2 'kill $! && wait $!'
shows '^rows +[1-9][0-9]* +[1-9]'

blocks=$(awk '/^    /{ if (!inside) ++count; inside = 1; next } { inside = 0 } END { print count }' "$page")
[[ $followed -eq $blocks ]] || fail "$page has $blocks blocks of commands, and $followed of them were followed"
say "passed."
