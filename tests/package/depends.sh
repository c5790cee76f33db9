#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Two packages of the same name, made for two architectures, depend on the same.
#   depends.sh PACKAGE.deb PACKAGE.deb
set -euo pipefail

# One a line, in the order of the alphabet: dpkg-shlibdeps writes them in no order of its own. The compiler's library got what
# programs use of it in different versions on different architectures (3.0 on amd64, 3.5 on armhf), so its version is left out.
depends() {
  dpkg-deb -f "$1" Depends | tr ',' '\n' | sed -E 's/^ *//; s/^(libgcc-s1) \(.*/\1/' | LC_ALL=C sort
}

for field in Package Version; do
  [[ $(dpkg-deb -f "$1" $field) == $(dpkg-deb -f "$2" $field) ]] || {
    echo "depends: $1 and $2 have different fields $field" >&2
    exit 1
  }
done
[[ $(depends "$1") != "" ]] || { echo "depends: $1 depends on nothing" >&2 && exit 1; }
diff --label "$1" --label "$2" -u <(depends "$1") <(depends "$2") || {
  echo "depends: ${1##*/} and ${2##*/} do not depend on the same" >&2
  exit 1
}
echo "${1##*/} and ${2##*/} depend on: $(dpkg-deb -f "$2" Depends)"
