# SPDX-License-Identifier: BSD-3-Clause
# Bare Debian 12 roots for the tests that source this. What is made once is kept in ${XDG_CACHE_HOME:-~/.cache}/stereod/roots.
test=$(basename "$0" .sh)
cache=${XDG_CACHE_HOME:-$HOME/.cache}/stereod/roots

say() { echo "$test: $*"; }
fail() {
  echo "$test: FAILED: $*" >&2
  exit 1
}

# need_root TOOL…: ends with 77, skipped, without root rights or a tool.
need_root() {
  local tool
  [[ $(id -u) -eq 0 ]] || { say "roots are made by root: skipped." && exit 77; }
  for tool in mmdebstrap "$@"; do
    command -v "$tool" >/dev/null || { say "no $tool here (toolchain/install-deps.sh --packages): skipped." && exit 77; }
  done
}

# in_namespace [ARGUMENT…]: runs the test once more with --inside and the arguments, where nothing that is mounted or left
# running gets out, and ends as it does. There it has a directory of its own, $work, and the network of the machine, which apt needs.
in_namespace() {
  work=$(mktemp -d)
  local status=0
  export work
  unshare --mount --pid --mount-proc --fork --kill-child bash "tests/package/$test.sh" --inside "$@" || status=$?
  rm -rf --one-file-system "$work"  # what was mounted there has gone with the namespace
  exit "$status"
}

# base NAME PACKAGES: a root with these packages, in the cache.
base() {
  local name=$1 packages=$2
  [[ ! -f $cache/$name.tar ]] || return 0
  say "making the root '$name'"
  mkdir -p "$cache/archives"
  toolchain/apt-sources.sh >"$cache/release.list" || fail "no apt sources of Debian 12 here."
  mmdebstrap --variant=apt --include="$packages" --skip=cleanup/apt/lists --aptopt='Apt::Install-Recommends "false"' \
    bookworm "$cache/$name.new.tar" "$cache/release.list" >"$cache/$name.log" 2>&1 ||
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

# boot: starts the root at $root with its systemd, in a network of its own, which is loopback; its first process is $booted.
boot() {
  umount -R "$root/proc" "$root/dev"
  rm "$root/usr/sbin/policy-rc.d"
  systemd-nspawn --quiet --directory="$root" --boot --private-network --register=no --keep-unit --console=pipe \
    </dev/null >"$work/boot.log" 2>&1 &
  local container=$! tries
  for tries in {1..600}; do
    booted=$(pgrep -P "$container" -x systemd || true)
    if [[ -n $booted ]] && in_booted systemctl --quiet is-active multi-user.target 2>/dev/null; then return; fi
    sleep 0.1
  done
  cat "$work/boot.log"
  fail "systemd does not come up in the root"
}
in_booted() { nsenter --target "$booted" --all env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C "$@"; }
# in_its_network COMMAND…: a command of this machine.
in_its_network() { nsenter --target "$booted" --net "$@"; }
