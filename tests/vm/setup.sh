#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Prepares, from Debian packages alone, what the tests in a virtual machine boot: Debian's kernel with the modules they
# need, v4l2loopback built for it, and a root file system with systemd. All of it stays in a cache between runs:
#
#   setup.sh           prints the directory that has vmlinuz, initrd.gz and rootfs.ext4
#
# Ends with status 3 and one sentence where it cannot be done: then the tests are skipped, not failed.
set -euo pipefail
exec 3>&1 1>&2  # what the tools have to say is not the answer
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cache=${XDG_CACHE_HOME:-$HOME/.cache}/stereod/vm

host_packages=(qemu-system-x86 mmdebstrap busybox-static cpio e2fsprogs gcc-12 make kmod)
guest_packages=(
  systemd systemd-sysv udev dbus kmod iproute2 procps v4l-utils
  # what the programs link to
  libspdlog1.10 libyaml-cpp0.7 libturbojpeg0 libjpeg62-turbo libpng16-16 liblcm1 libglib2.0-0 libv4l-0 libcpp-httplib0.11
)
modules=(uvcvideo vhci-hcd v4l2loopback vivid dummy 9p 9pnet_virtio virtio_pci virtio_blk virtio_rng ext4)
boot_modules=(virtio_pci virtio_blk ext4)  # before there is a root file system

say() { echo "vm/setup: $*"; }
cannot() {
  say "$*"
  exit 3
}

install_host_packages() {
  local package missing=()
  for package in "${host_packages[@]}"; do
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [[ ${#missing[@]} -gt 0 ]] || return 0
  say "installing ${missing[*]} with apt"
  DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 install -y --no-install-recommends \
    "${missing[@]}" >/dev/null || cannot "apt cannot install ${missing[*]}"
}

# The newest kernel that the package lists know, for example 6.1.0-40-amd64.
kernel_release() { apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: linux-image-//p' | head -n 1; }

# Unpacks kernel and headers into $work/kernel.
fetch_kernel() {
  mkdir -p "$work/debs" "$work/kernel"
  (cd "$work/debs" &&
    apt-get -qq download "linux-image-$release" "linux-headers-$release" "linux-headers-${release%-amd64}-common" \
      linux-kbuild-6.1 v4l2loopback-dkms >/dev/null 2>&1) || cannot "the packages of kernel $release cannot be had"
  local deb
  for deb in "$work"/debs/*.deb; do dpkg-deb -x "$deb" "$work/kernel"; done
}

build_loopback() {
  local headers=$work/kernel/usr/src/linux-headers-$release source=$work/v4l2loopback
  sed -i "s#include /usr/src#include $work/kernel/usr/src#" "$headers/Makefile"
  mkdir -p "$source"
  cp "$work"/kernel/usr/src/v4l2loopback-*/*.[ch] "$source"
  echo 'obj-m := v4l2loopback.o' >"$source/Kbuild"
  make -s -C "$headers" M="$source" modules >"$work/v4l2loopback.log" 2>&1 ||
    { cat "$work/v4l2loopback.log"; say "v4l2loopback cannot be built"; exit 1; }
  install -D -t "$work/kernel/lib/modules/$release/extra" "$source/v4l2loopback.ko"
  depmod -b "$work/kernel" "$release"
}

# Prints the files of modules and of what they need, in the order of loading.
module_files() {
  local module
  for module in "$@"; do
    modprobe -d "$work/kernel" -S "$release" --show-depends "$module" | sed -n 's/^insmod \([^ ]*\).*/\1/p'
  done | awk '!seen[$0]++'
}

make_root() {
  local root=$work/root file to
  # The machine's own lists of packages; without documentation and translations.
  mmdebstrap -q --variant=minbase --include="$(tr ' ' ',' <<<"${guest_packages[*]}")" \
    --aptopt='Apt::Install-Recommends "false"' --dpkgopt='path-exclude=/usr/share/doc/*' \
    --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
    bookworm "$work/root.tar" "${sources[@]}" || cannot "the guest's packages cannot be had: ${guest_packages[*]}"
  mkdir "$root"
  tar -C "$root" -xf "$work/root.tar" --exclude='./dev/*'
  to=$root/lib/modules/$release
  mkdir -p "$to"
  cp "$work/kernel/lib/modules/$release"/modules.{order,builtin,builtin.modinfo} "$to"
  for file in $(module_files "${modules[@]}"); do
    install -D "$file" "$to/${file#*/lib/modules/"$release"/}"
  done
  depmod -b "$root" "$release"
  cp -r "$here/guest/etc" "$root"
  mkdir -p "$root/share" "$root/etc/systemd/system/multi-user.target.wants"
  ln -s ../scenario.service "$root/etc/systemd/system/multi-user.target.wants"
  sed -i 's/^root:[^:]*/root:/' "$root/etc/shadow"
  # Plenty of room for what a scenario installs; only what is written takes any.
  mke2fs -q -t ext4 -O ^has_journal -E root_owner=0:0 -d "$root" "$work/rootfs.ext4" 1G
}

make_initrd() {
  local tree=$work/initrd file number=10
  mkdir -p "$tree"/{bin,dev,proc,sys,newroot,modules}
  cp "$(command -v busybox)" "$tree/bin"
  install -m 755 "$here/guest/init" "$tree/init"
  for file in $(module_files "${boot_modules[@]}"); do
    cp "$file" "$tree/modules/$((number++))-$(basename "$file")"
  done
  (cd "$tree" && find . | cpio -o -H newc --quiet | gzip -1) >"$work/initrd.gz"
}

command -v apt-get >/dev/null || cannot "this system has no apt"
[[ $(uname -m) == x86_64 ]] || cannot "the virtual machine is an x86-64 one, this machine is not"
[[ $(id -u) -eq 0 ]] || cannot "making the image takes root"
release=$(kernel_release)
[[ -n $release ]] || cannot "the package lists do not know linux-image-amd64; has 'apt-get update' been run?"
sources=()
for file in /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list; do
  if [[ -s $file ]]; then sources+=("$file") && break; fi
done

install_host_packages
key=$({ echo "$release ${guest_packages[*]}"; cat "$here/setup.sh"; find "$here/guest/etc" "$here/guest/init" -type f \
  -exec sha256sum {} +; } | sed "s#$here##" | sha256sum | cut -c -16)
if [[ ! -f $cache/$key/done ]]; then
  say "making the image (kernel $release), about a minute and a half"
  mkdir -p "$cache"
  work=$(mktemp -d "$cache/making-XXXXXX")
  trap 'rm -rf "$work"' EXIT
  chmod 755 "$work"
  fetch_kernel
  build_loopback
  make_root
  make_initrd
  find "$cache" -mindepth 1 -maxdepth 1 -mtime +7 -exec rm -rf {} +
  mkdir "$work/ready"
  cp --sparse=always "$work/rootfs.ext4" "$work/initrd.gz" "$work/ready"
  cp "$work/kernel/boot/vmlinuz-$release" "$work/ready/vmlinuz"
  touch "$work/ready/done"
  mv "$work/ready" "$cache/$key"
fi
echo "$cache/$key" >&3
