#!/usr/bin/env bash
# Unpacks what stereod is built against for a foreign machine: Debian's libraries and headers of that architecture, from
# this machine's own apt sources, and a list of their packages, from which dependencies are told when packages are made.
#   make-sysroot.sh ARCH [--again]        ARCH: arm64, armhf or i386; prints the folder, which is made only once, and again
#                                         when other packages are wanted than the last time
# It lies in $STEREOD_SYSROOTS, or in .cache/stereod/sysroots in the home directory.
set -euo pipefail

die() {
  echo "make-sysroot: $*" >&2
  exit 1
}

arch=${1:-}
case $arch in
  arm64 | armhf | i386) ;;
  *) die "usage: toolchain/make-sysroot.sh arm64|armhf|i386 [--again]" ;;
esac
sysroots=${STEREOD_SYSROOTS:-$HOME/.cache/stereod/sysroots}
sysroot=$sysroots/$arch
packages=libc6-dev,libstdc++-12-dev,liblcm-dev,libv4l-dev,libyaml-cpp-dev,libspdlog-dev,libcli11-dev
packages+=,libturbojpeg0-dev,libjpeg62-turbo-dev,libpng-dev,libsystemd-dev,libgtest-dev,libgmock-dev,libcpp-httplib-dev
if [[ -e $sysroot/.complete && $(cat "$sysroot/.complete") == "$packages" && ${2:-} != --again ]]; then
  echo "$sysroot"
  exit 0
fi
command -v mmdebstrap >/dev/null || die "no mmdebstrap here: apt install mmdebstrap"

mkdir -p "$sysroots"
sources=$sysroots/$arch.sources
"$(dirname "${BASH_SOURCE[0]}")/apt-sources.sh" >"$sources" || die "no apt sources of Debian 12 in /etc/apt."
rm -rf "$sysroot"
log=$sysroots/$arch.log
mmdebstrap --variant=extract --architectures="$arch" --include="$packages" \
  --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
  --extract-hook="mkdir -p '$sysroot.debs' && cp \"\$1\"/var/cache/apt/archives/*.deb '$sysroot.debs'" \
  bookworm "$sysroot" "$sources" >"$log" 2>&1 || die "mmdebstrap failed; see $log"

# Links that start at the root would lead out of the sysroot.
find "$sysroot" -xtype l -lname '/*' | while read -r link; do
  target=$(readlink "$link")
  ln -snf "$(realpath -m --relative-to="$(dirname "$link")" "$sysroot$target")" "$link"
done

# Unpacked packages are not known to dpkg. dpkg-shlibdeps looks libraries up by the path it found them under, which begins
# with the sysroot, in the database that DPKG_ADMINDIR names.
admin=$sysroot/var/lib/dpkg
rm -rf "$admin"
mkdir -p "$admin/info" "$admin/updates" "$admin/triggers"
echo 1 >"$admin/info/format"
: >"$admin/status" && : >"$admin/diversions" && : >"$admin/statoverride" && echo "$arch" >"$admin/arch"
for deb in "$sysroot.debs"/*.deb; do
  control=$(mktemp -d)
  dpkg-deb -e "$deb" "$control"
  name=$(dpkg-deb -f "$deb" Package)
  key=$name
  [[ $(dpkg-deb -f "$deb" Multi-Arch) != same ]] || key=$name:$arch
  for file in shlibs symbols; do [[ ! -f $control/$file ]] || cp "$control/$file" "$admin/info/$key.$file"; done
  dpkg-deb --fsys-tarfile "$deb" | tar -t | sed -e "s#^\.#$sysroot#" -e 's#/$##' >"$admin/info/$key.list"
  { echo "Package: $name"; echo "Status: install ok installed"; sed '/^Package:/d' "$control/control"; echo; } >>"$admin/status"
  rm -rf "$control"
done
rm -rf "$sysroot.debs"
rm "$sources"
echo "$packages" >"$sysroot/.complete"
echo "$sysroot"
