#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Unpacks what stereod is built against for a foreign machine: Debian's libraries and headers of that architecture, from
# this machine's own apt sources, and a list of their packages, from which dependencies are told when packages are made.
# Needs no root rights: apt works in a directory of its own. Only where compiler or emulator of the preset ARCH are missing are
# they installed first (install-deps.sh --cross ARCH); without root rights and sudo it names the command and ends.
#   make-sysroot.sh ARCH [--again]        ARCH: arm64, armhf or i386; prints the directory, which is made only once, and again
#                                         when other packages are wanted than the last time
# It lies in .cache/stereod/sysroots in the home directory, where the presets of CMakePresets.json look for it.
set -euo pipefail

die() {
  echo "make-sysroot: $*" >&2
  exit 1
}

usage="usage: toolchain/make-sysroot.sh arm64|armhf|i386 [--again]"
arch=${1:-}
[[ $arch == arm64 || $arch == armhf || $arch == i386 ]] || die "$usage"
[[ $# -le 2 && ${2:---again} == --again ]] || die "$usage"
[[ -n ${HOME:-} ]] || die "HOME is not set; the sysroot is kept in \$HOME/.cache/stereod/sysroots."
sysroots=$HOME/.cache/stereod/sysroots
sysroot=$sysroots/$arch
packages=(libc6-dev libstdc++-12-dev liblcm-dev libv4l-dev libyaml-cpp-dev libspdlog-dev libcli11-dev libturbojpeg0-dev
  libjpeg62-turbo-dev libpng-dev libsystemd-dev libgtest-dev libgmock-dev libcpp-httplib-dev)
"$(dirname "${BASH_SOURCE[0]}")/install-deps.sh" --cross "$arch" >&2
if [[ -e $sysroot/.complete && $(cat "$sysroot/.complete") == "${packages[*]}" && ${2:-} != --again ]]; then
  echo "$sysroot"
  exit 0
fi

# The new sysroot is made beside the old one and replaces it at the end: a failure keeps the old one.
mkdir -p "$sysroots"
log=$sysroots/$arch.log
work=$(mktemp -d -p "$sysroots")
trap 'rm -rf "$work"' EXIT
new=$work/root
mkdir -p "$work"/apt/{etc/apt.conf.d,etc/preferences.d,etc/sources.list.d,state/lists/partial,cache/archives/partial} "$new"
"$(dirname "${BASH_SOURCE[0]}")/apt-sources.sh" >"$work/apt/etc/sources.list.d/debian.list" ||
  die "no apt sources of Debian 12 in /etc/apt."

# An apt that knows nothing to be installed, so that it fetches all that the packages depend on.
: >"$work/apt/state/status"
foreign_apt() {
  apt-get -q -y -o APT::Architecture="$arch" -o APT::Architectures="$arch" -o APT::Install-Recommends=false \
    -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/apt/etc/sources.list.d" \
    -o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts="$work/apt/etc/preferences.d" \
    -o Dir::State="$work/apt/state" -o Dir::State::status="$work/apt/state/status" -o Dir::Cache="$work/apt/cache" \
    -o APT::Sandbox::User= -o Debug::NoLocking=true "$@" >>"$log" 2>&1
}
: >"$log"
foreign_apt update --error-on=any || die "the lists of packages for $arch cannot be fetched: $(grep -m 1 '^[EW]:' "$log" || true) (all of it: $log)"
foreign_apt --download-only install "${packages[@]}" ||
  die "the packages for $arch cannot be fetched: $(grep -m 1 '^E:' "$log" || true) (all of it: $log)"

# Unpacked packages are not known to dpkg. dpkg-shlibdeps looks libraries up by the path it found them under, which begins
# with the sysroot, in the database that DPKG_ADMINDIR names.
admin=$new/var/lib/dpkg
mkdir -p "$admin/info" "$admin/updates" "$admin/triggers"
echo 1 >"$admin/info/format"
: >"$admin/status" && : >"$admin/diversions" && : >"$admin/statoverride" && echo "$arch" >"$admin/arch"
for deb in "$work"/apt/cache/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$deb" | tar -x -C "$new" --no-same-owner --no-same-permissions \
    --exclude='./usr/share/man/*' --exclude='./usr/share/locale/*' || die "$(basename "$deb") cannot be unpacked; is the disk full?"
  control=$work/control
  dpkg-deb -e "$deb" "$control"
  name=$(dpkg-deb -f "$deb" Package)
  key=$name
  [[ $(dpkg-deb -f "$deb" Multi-Arch) != same ]] || key=$name:$arch
  for file in shlibs symbols; do [[ ! -f $control/$file ]] || cp "$control/$file" "$admin/info/$key.$file"; done
  dpkg-deb --fsys-tarfile "$deb" | tar -t | sed -e "s#^\.#$sysroot#" -e 's#/$##' >"$admin/info/$key.list"
  { echo "Package: $name"; echo "Status: install ok installed"; sed '/^Package:/d' "$control/control"; echo; } >>"$admin/status"
  rm -rf "$control"
done

# Links that start at the root would lead out of the sysroot.
find "$new" -type l -lname '/*' | while read -r link; do
  target=$(readlink "$link")
  ln -snf "$(realpath -m --relative-to="$(dirname "$link")" "$new$target")" "$link"
done
echo "${packages[*]}" >"$new/.complete"
rm -rf "$sysroot"
mv "$new" "$sysroot"
echo "$sysroot"
