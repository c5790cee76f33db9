#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs, removes, purges, reinstalls and upgrades the packages in bare Debian 12 roots; builds another project's program
# against libstereod-dev and receives frames with it; runs lintian on the packages.
#   roots.sh [DIRECTORY-OF-DEBS]      default: makes the packages (preset package)
# Ends with 77, skipped, without root rights or mmdebstrap. The roots and what apt fetched are kept in
# ${XDG_CACHE_HOME:-~/.cache}/stereod/roots.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. tests/package/root.sh
if [[ ${1:-} != --inside ]]; then
  need_root
  debs=${1:-}
  if [[ -z $debs ]]; then
    debs=build/package
    { cmake --preset package && cmake --build --preset package -j "${JOBS:-$(nproc)}" && rm -f $debs/*.deb &&
      cpack --preset package; } >/dev/null || fail "the packages could not be made."
  fi
  in_namespace "$(realpath "$debs")"
fi
debs=$2
# apt without a terminal, as on a robot that updates itself: dpkg fails if it would have to ask.
apt() { in_root apt-get -qq -y --no-install-recommends "$@" </dev/null >"$work/apt.log" 2>&1; }
need_apt() { apt "$@" || { tail -n 30 "$work/apt.log"; fail "apt-get $*"; }; }
in_network() { toolchain/own-network.sh "$@"; }
has() { [[ -e $root$1 ]] || fail "$2, but $1 is not there"; }
lacks() { [[ ! -e $root$1 ]] || fail "$2, but $1 is there"; }

# newer VERSION [SED-EXPRESSION]: stereod's package again under another version, its configuration changed; prints its name
# within the root.
newer() {
  local tree=$work/newer
  rm -rf "$tree"
  dpkg-deb -R "$debs"/stereod_*.deb "$tree"
  sed -i "s/^Version: .*/Version: $1/" "$tree/DEBIAN/control"
  [[ -z ${2:-} ]] || sed -i "$2" "$tree/etc/stereod/stereod.yaml"
  (cd "$tree" && find . -type f ! -path './DEBIAN/*' -printf '%P\0' | xargs -0 md5sum >DEBIAN/md5sums)
  dpkg-deb --root-owner-group -b "$tree" "$root/tmp/stereod_$1.deb" >/dev/null
  echo "/tmp/stereod_$1.deb"
}

# streams: stereod of the root publishes a rendered scene, and another process of the root receives it. In a network of their
# own.
streams() {
  in_network env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin chroot "$root" /bin/sh -c '
    stereod --config /usr/share/doc/stereod/examples/demo.yaml 2>/tmp/stereod.log & daemon=$!
    "$@"; status=$?
    kill $daemon; wait $daemon || status="$status, stereod $?"
    [ "$status" = 0 ] || { cat /tmp/stereod.log; echo "status $status"; exit 1; }' sh "$@"
}

[[ -n $(compgen -G "$debs/stereod_*.deb") && -n $(compgen -G "$debs/libstereod-dev_*.deb") &&
  -n $(compgen -G "$debs/stereo-calibrate_*.deb") ]] || fail "not all three packages are in $debs"
daemon_deb=/debs/$(basename "$debs"/stereod_*.deb)
calibrate_deb=/debs/$(basename "$debs"/stereo-calibrate_*.deb)
development_deb=/debs/$(basename "$debs"/libstereod-dev_*.deb)
base bare ca-certificates
enter bare

say "install"
need_apt install "$daemon_deb"
for file in /usr/bin/stereod /usr/bin/stereo-tap /usr/bin/stereo-match /usr/bin/stereo-view /etc/stereod/stereod.yaml \
  /lib/systemd/system/stereod.service /lib/systemd/system/stereod@.service /lib/systemd/system/stereod-multicast.service \
  /lib/sysctl.d/00-stereod.conf /lib/udev/rules.d/60-stereod.rules /usr/share/man/man8/stereod.8.gz \
  /usr/share/man/man5/stereod.yaml.5.gz /usr/share/doc/stereod/bill-of-materials.spdx; do
  has "$file" "stereod is installed"
done
in_root id -nG stereod | grep -qw video || fail "there is no user stereod in the group video"
[[ -z $(find "$root"/etc/systemd -name '*stereod*') ]] || fail "it has enabled itself"
in_root stereod --check-config --config /usr/share/doc/stereod/examples/demo.yaml >/dev/null || fail "stereod does not run"
for program in stereo-tap stereo-match stereo-view; do
  in_root "$program" --help >/dev/null || fail "$program does not run"
done
streams stereo-tap check --seconds 4 >"$work/check.txt" 2>&1 || { cat "$work/check.txt"; fail "stereo-tap receives nothing"; }
say "  $(sed -n 's/^rows  *\([0-9]*\)  *\([0-9]*\) .*/\2 of \1 rows received/p' "$work/check.txt")"
for library in liblcm1 libcpp-httplib0.11 libcli11-dev; do
  grep -q "^PackageName: $library\$" "$root/usr/share/doc/stereod/bill-of-materials.spdx" || fail "the bill of materials lacks $library"
done

say "the same version once more"
need_apt install --reinstall "$daemon_deb"

# Two later versions of the package: its own with another patch number.
version=$(dpkg-deb -f "$debs"/stereod_*.deb Version)
first_upgrade=${version%.*}.$((${version##*.} + 1)) second_upgrade=${version%.*}.$((${version##*.} + 2))

say "upgrade; a changed configuration survives"
echo '# my own line' >>"$root/etc/stereod/stereod.yaml"
echo 'left: mine' >"$root/etc/stereod/calibration.yaml"
need_apt install "$(newer "$first_upgrade")"
[[ $(in_root dpkg-query -W -f='${Version}' stereod) == "$first_upgrade" ]] || fail "it is not the new version"
grep -q '^# my own line$' "$root/etc/stereod/stereod.yaml" || fail "the upgrade has overwritten the configuration"

say "upgrade that changes the configuration too"
need_apt -o Dpkg::Options::=--force-confold install "$(newer "$second_upgrade" "1i # from version $second_upgrade")"
grep -q '^# my own line$' "$root/etc/stereod/stereod.yaml" || fail "the upgrade has overwritten the configuration"
grep -q "^# from version $second_upgrade\$" "$root/etc/stereod/stereod.yaml.dpkg-dist" || fail "the new configuration is not beside the old"

say "remove"
need_apt remove stereod
lacks /usr/bin/stereod "it is removed"
lacks /lib/systemd/system/stereod.service "it is removed"
has /etc/stereod/stereod.yaml "configuration stays until the package is purged"

say "install again: the configuration is the one that was left"
need_apt install "/tmp/stereod_$second_upgrade.deb"
grep -q '^# my own line$' "$root/etc/stereod/stereod.yaml" || fail "the configuration was overwritten"

say "purge, with recordings on a disk of their own"
mkdir -p "$root/var/lib/stereod"
mount -t tmpfs tmpfs "$root/var/lib/stereod"
touch "$root/var/lib/stereod/run.lcm"
need_apt purge stereod
lacks /var/lib/stereod/run.lcm "it is purged"
umount "$root/var/lib/stereod"
rmdir "$root/var/lib/stereod"
in_root getent passwd stereod >/dev/null && fail "the user stereod has stayed"
has /etc/stereod/calibration.yaml "a calibration is the user's own"
rm -r "$root/etc/stereod"
left=$(cd "$root" && find etc usr lib var run -name '*stereod*' ! -path 'var/log/*' ! -path 'var/cache/*' ! -name '*.deb')
[[ -z $left ]] || fail "left behind: $left"

say "install after a purge"
need_apt install "$daemon_deb"
has /etc/stereod/stereod.yaml "it is installed"

say "a person's account named stereod is neither taken nor deleted"
need_apt purge stereod
in_root useradd --uid 1000 --shell /bin/bash stereod
if apt install "$daemon_deb"; then fail "it was installed over a person's account"; fi
grep -q "is a person's (uid 1000)" "$work/apt.log" || { cat "$work/apt.log"; fail "it does not say why it cannot be installed"; }
need_apt purge stereod
in_root getent passwd stereod >/dev/null || fail "the person's account was deleted"
in_root userdel stereod

say "stereo-calibrate, without stereod, as on a laptop"
need_apt install "$calibrate_deb"
has /usr/share/man/man1/stereo-calibrate.1.gz "it is installed"
in_root stereo-calibrate board --output /tmp/board.pdf >"$work/board.txt" 2>&1 || { cat "$work/board.txt"; fail "it draws no board"; }
has /tmp/board.pdf "a board was drawn"
for library in libopencv-calib3d liblapack3; do  # the second by an alternative
  grep -q "^PackageName: $library" "$root/usr/share/doc/stereo-calibrate/bill-of-materials.spdx" ||
    fail "its bill of materials lacks $library"
done
need_apt purge stereo-calibrate
left=$(cd "$root" && find etc usr lib var run -name '*stereo-calibrate*' ! -path 'var/log/*' ! -path 'var/cache/*')
[[ -z $left ]] || fail "left behind: $left"

base development ca-certificates,g++,cmake,make,pkg-config
enter development
say "another project's program"
need_apt install "$daemon_deb" "$development_deb"
cp -r tests/package/consumer "$root/home/consumer"
in_root sh -ec 'cd /home/consumer && cmake -S . -B build >/dev/null && cmake --build build >/dev/null' || fail "it does not build with CMake"
in_root sh -ec 'cd /home/consumer && g++ -std=c++17 consumer.cpp -o by-pkg-config $(pkg-config --cflags --libs stereod)' ||
  fail "it does not build with pkg-config"
for program in build/consumer by-pkg-config; do
  streams "/home/consumer/$program" >"$work/frames.txt" 2>&1 || { cat "$work/frames.txt"; fail "$program received no frames"; }
  say "  $program: $(tail -n 1 "$work/frames.txt")"
done

if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error "$debs"/*.deb || fail "lintian finds errors"
  say "lintian finds no errors"
else
  say "no lintian here: not looked at by it"
fi
say "passed."
