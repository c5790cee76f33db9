#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs with apt what building stereod and running its demo needs, and on request more:
#   --tests        the suites format, tidy, tests, asan and tsan of tests/run.sh
#   --emulation    tests, and running them on other CPUs, fuzzing, counting instructions
#   --cross ARCH   building for arm64, armhf or i386 (with toolchain/make-sysroot.sh, which calls this) and emulating it
#   --packages     tests, every architecture, and testing the packages
# Does nothing, and asks for no password, if everything is installed.
set -euo pipefail

build_packages=(
  g++ cmake ninja-build pkg-config
  liblcm-dev liblcm-bin        # the messages on the wire, and the generator of their classes
  libyaml-cpp-dev libspdlog-dev libcli11-dev
  libturbojpeg0-dev libjpeg62-turbo-dev libpng-dev zlib1g-dev
  libsystemd-dev               # status for systemd
  libv4l-dev                   # formats of cameras that are not read directly
  iproute2 util-linux          # ip and unshare: the demo's and the tests' own network
  dpkg-dev file                # for cpack: what packages depend on
)
test_packages=(libgtest-dev libgmock-dev libopencv-dev poppler-utils libcpp-httplib-dev nftables chromium
  liblcm-java libjchart2d-java default-jre default-jdk-headless xvfb xdotool  # stereod-spy
  ccache                       # the tests are built in several ways, and again
  clang-format-14 clang-tidy-14  # the suites format and tidy
)
# The Aloe photographs. Some mirrors have no documentation packages, and the demo runs without them.
optional_packages=(opencv-doc)
emulation_packages=(
  qemu-user g++-aarch64-linux-gnu g++-arm-linux-gnueabihf g++-i686-linux-gnu googletest
  clang-14 llvm-14 libclang-rt-14-dev valgrind
)
declare -A cross_compilers=([arm64]=g++-aarch64-linux-gnu [armhf]=g++-arm-linux-gnueabihf [i386]=g++-i686-linux-gnu)
foreign_packages=(
  qemu-user "${cross_compilers[@]}"                                          # tests/cross/run.sh
  mmdebstrap lintian openssh-client git systemd-container                     # tests/package
)

die() {
  echo "install-deps: $*" >&2
  exit 1
}

packages=("${build_packages[@]}")
case "${1:-}" in
  '') ;;
  --tests)
    packages+=("${test_packages[@]}")
    optional_packages+=(chromium)  # the page of stereo-view in a browser
    ;;
  --emulation)
    packages+=("${test_packages[@]}")
    optional_packages+=("${emulation_packages[@]}")
    ;;
  --cross)
    [[ -n ${2:-} && -n ${cross_compilers[$2]:-} ]] || die "--cross needs an architecture: arm64, armhf or i386"
    packages+=(qemu-user "${cross_compilers[$2]}")
    ;;
  --packages) packages+=("${test_packages[@]}" "${foreign_packages[@]}") ;;
  *) die "usage: toolchain/install-deps.sh [--tests | --emulation | --cross ARCH | --packages]" ;;
esac

# Prints those of its arguments that are not installed.
missing_of() {
  local package
  for package in "$@"; do
    if ! dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed; then
      echo "$package"
    fi
  done
}

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  die "this system has no apt; install the contents of these Debian packages: ${packages[*]}"
fi

mapfile -t missing < <(missing_of "${packages[@]}")
mapfile -t optional_missing < <(missing_of "${optional_packages[@]}")
if [[ ${#missing[@]} -eq 0 && ${#optional_missing[@]} -eq 0 ]]; then
  echo "install-deps: all ${#packages[@]} packages are installed."
  exit 0
fi

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    [[ ${#missing[@]} -eq 0 ]] || die "no sudo here; as root: apt-get install ${missing[*]}"
    exit 0
  fi
  as_root=(sudo)
  # Optional packages are not worth asking for a password.
  [[ ${#missing[@]} -gt 0 ]] || as_root=(sudo -n)
fi
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq "$@"; }
install_packages() { apt install --no-install-recommends -y "$@" >/dev/null; }

echo "install-deps: installing ${missing[*]} ${optional_missing[*]} with apt."
if [[ ${#missing[@]} -gt 0 ]]; then
  apt update || die "'apt-get update' failed; is the network up?"
  install_packages "${missing[@]}" || die "apt could not install: ${missing[*]}."
elif ! apt update; then
  optional_missing=()
fi
for package in "${optional_missing[@]}"; do
  install_packages "$package" || echo "install-deps: apt has no $package; continuing without it."
done
