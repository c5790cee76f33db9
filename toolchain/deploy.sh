#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Deploys stereod to a robot: builds the package for the robot's architecture, copies and installs it, restarts the service
# and prints its status and log.
#   toolchain/deploy.sh [USER@]HOST [SSH-OPTION…]       for example: toolchain/deploy.sh robot@192.168.1.20 -p 2222
# The robot needs: Debian 12, ssh with a key, and root or sudo without a password.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

die() {
  echo "deploy: $*" >&2
  exit 1
}

host=${1:-}
[[ -n $host && $host != -* ]] || die "usage: toolchain/deploy.sh [USER@]HOST [SSH-OPTION…]"
shift
command -v ssh >/dev/null || die "there is no ssh here: apt install openssh-client"
# remote COMMAND: runs it on the robot. answer LINES COMMAND: prints the last LINES of its output; a login greeting comes first.
remote() { ssh -o BatchMode=yes -o ConnectTimeout=10 "${ssh_options[@]}" "$host" "$@"; }
answer() {
  local lines=$1 said
  shift
  said=$(remote "$@") && tail -n "$lines" <<<"$said"
}
ssh_options=("$@")

# What the host is, one answer a line.
ask='. /etc/os-release 2>/dev/null; echo "${ID:-unknown} ${VERSION_ID:-}"
  dpkg --print-architecture 2>/dev/null || echo none
  if [ "$(id -u)" = 0 ]; then echo root; elif sudo -n true 2>/dev/null; then echo sudo; else echo nobody; fi'
errors=$(mktemp)
trap 'rm -f "$errors"' EXIT
answers=$(answer 3 "$ask" 2>"$errors") || {
  why=$(tail -n 1 "$errors" | tr -d '\r' | sed 's,\.$,,')
  [[ $why != *'Host key verification failed'* ]] ||
    die "$host is not the machine that ssh knows by that name, or none it knows: log in once by hand (ssh $host) and see what it says."
  die "cannot log in at $host by ssh: $why. Is it on, and does it have your key (ssh-copy-id $host)?"
}
{ read -r system release && read -r arch && read -r rights; } <<<"$answers" || die "$host gave no usable answer."

[[ $system == debian && $release == 12 ]] ||
  die "$host runs $system ${release:-of no version}, but the package is made for Debian 12, whose libraries it needs."
here=$(dpkg --print-architecture)
case $arch in
  "$here") preset=package ;;
  arm64 | armhf | i386) preset=$arch ;;
  amd64) die "$host is amd64, for which packages are made on amd64 only; this machine is $here." ;;
  none) die "$host has no dpkg, so nothing can be installed there." ;;
  *) die "$host is of the architecture $arch; packages are made for amd64, arm64, armhf and i386." ;;
esac
[[ $rights != nobody ]] || die "at $host you are neither root nor may use sudo without a password; log in as root@… or permit it."
as_root=
[[ $rights == root ]] || as_root='sudo -n '

# Without tests, in a directory of its own.
build=build/package
if [[ $preset != package ]]; then
  toolchain/make-sysroot.sh "$arch" >/dev/null || die "there are no libraries to build against for $arch, see above."
  build=build/package-$arch
fi
echo "deploy: building for $host, $arch"
log=$build.log
mkdir -p build
rm -f "$build"/*.deb
{ cmake --preset "$preset" -B "$build" -DSTEREOD_TESTS=OFF && cmake --build "$build" -j "${JOBS:-$(nproc)}" &&
  cpack --config "$build/CPackConfig.cmake" -G DEB; } >"$log" 2>&1 ||
  { tail -n 20 "$log" >&2 && die "the package cannot be built; all of it: $log"; }
package=$(ls "$build"/stereod_*_"$arch".deb)

echo "deploy: installing $(basename "$package"), $(($(stat -c %s "$package") / 1024)) KiB"
directory=$(answer 1 'mktemp -d /tmp/stereod-XXXXXX') || die "no directory can be made in /tmp of $host; is its disk full?"
[[ $directory =~ ^/tmp/stereod-[A-Za-z0-9]{6}$ ]] || die "$host answers '$directory' to mktemp; expected /tmp/stereod-XXXXXX."
remote "cat >$directory/stereod.deb || { rm -rf $directory; false; }" <"$package" ||
  die "the package cannot be copied to $host; is its disk full?"
# One's own configuration stays; a changed one of the package is laid beside it. A board that has never fetched lists of packages
# does so if it must.
install="${as_root}env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends --reinstall --allow-downgrades \
  -o Dpkg::Options::=--force-confold install $directory/stereod.deb </dev/null"
remote "chmod 755 $directory; $install || { ${as_root}apt-get -q update </dev/null && $install; }; status=\$?
  rm -rf $directory; exit \$status" >"$errors" 2>&1 || {
  cat "$errors" >&2
  die "apt-get on $host could not install it, see above; what it depends on must be in the board's apt sources or installed before."
}

if ! remote 'test -d /run/systemd/system'; then
  echo "deploy: installed; systemd does not run on $host, so nothing was started."
  exit 0
fi
# The package has restarted the services that ran. A robot with several pairs has instances, whose cameras stay theirs.
units=$(answer 1 'if systemctl -q is-enabled stereod || systemctl -q is-active stereod; then pairs=
  else pairs=$(systemctl --plain --no-legend --all list-units "stereod@*.service" | cut -d " " -f 1); fi
  echo units: ${pairs:-stereod.service}' 2>/dev/null) || die "$host does not answer any more."
[[ $units == 'units: '* ]] || die "$host answers '$units' to systemctl, which makes no sense."
units=${units#units: }
started=0
remote "${as_root}systemctl start $units" || started=1
remote "${as_root}systemctl --no-pager --full status $units
  ${as_root}journalctl --no-pager -o cat $(printf -- '-u %s ' $units)-n 20" || true
[[ $started -eq 0 ]] || die "stereod does not start on $host; its own words are above, its configuration is in /etc/stereod there."
remote "systemctl -q is-enabled $units" >/dev/null ||
  echo "deploy: it runs now, but not after the next start of $host: ssh $host ${as_root}systemctl enable $units"
echo "deploy: done."
