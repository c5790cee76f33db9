# Bare Debian 12 roots for the tests that source this: $work is a folder of theirs, in a mount namespace of their own; say and
# fail tell people. What is made once is kept in ${XDG_CACHE_HOME:-~/.cache}/stereod/roots.
cache=${XDG_CACHE_HOME:-$HOME/.cache}/stereod/roots

# base NAME PACKAGES: a root with these packages, in the cache.
base() {
  local name=$1 packages=$2
  [[ ! -f $cache/$name.tar ]] || return 0
  say "making the root '$name'"
  mkdir -p "$cache/archives"
  toolchain/apt-sources.sh >"$cache/release.sources" || fail "no apt sources of Debian 12 here."
  mmdebstrap --variant=apt --include="$packages" --skip=cleanup/apt/lists --aptopt='Apt::Install-Recommends "false"' \
    bookworm "$cache/$name.new.tar" "$cache/release.sources" >"$cache/$name.log" 2>&1 ||
    fail "mmdebstrap: see $cache/$name.log"
  mv "$cache/$name.new.tar" "$cache/$name.tar"
}

# enter NAME: unpacks it to $root.
enter() {
  root=$work/$1
  mkdir "$root"
  mount -t tmpfs -o size=3g tmpfs "$root"
  tar -C "$root" -xf "$cache/$1.tar" --exclude='./dev/*'
  mkdir -p "$root/debs" "$root/proc" "$root/dev" "$root/var/cache/apt/archives"
  [[ -z ${debs:-} ]] || mount --bind "$debs" "$root/debs"
  mount --bind "$cache/archives" "$root/var/cache/apt/archives"
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  rm -f "$root/etc/apt/apt.conf.d/docker-clean"
  printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" && chmod 755 "$root/usr/sbin/policy-rc.d"
}
in_root() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C chroot "$root" "$@"; }
