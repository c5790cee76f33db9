#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# That toolchain/apt-sources.sh finds Debian 12's own sources in either form and nothing else.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/sources.list.d"

# expect FILE-WITH-SOURCES EXPECTED-LINES
expect() {
  local found
  found=$(bash toolchain/apt-sources.sh "$work") || true
  [[ $found == "$2" ]] && return
  printf 'apt_sources: %s\n%s\n--- found:\n%s\n--- expected:\n%s\n' "$1" "$(cat "$work"/sources.list* "$work"/sources.list.d/* 2>/dev/null)" "$found" "$2"
  exit 1
}

expect 'no sources at all' ''

cat >"$work/sources.list" <<'END'
# deb http://old.example/debian bookworm main
deb http://one.example/debian bookworm main contrib # the first
 deb  [ arch=amd64,i386  signed-by=/two.gpg ]  http://two.example/debian   bookworm main
deb [arch=amd64] http://three.example/debian/ bookworm main
deb-src http://one.example/debian bookworm main
deb http://one.example/debian-security bookworm-security main
END
lines='deb http://one.example/debian bookworm main contrib
deb [signed-by=/two.gpg] http://two.example/debian bookworm main
deb http://three.example/debian/ bookworm main'
expect 'lines' "$lines"

# A third party's source whose suite has Debian's name must not hide Debian's own.
cat >"$work/sources.list.d/containers.sources" <<'END'
Types: deb
URIs: https://containers.example/linux/debian
Suites: bookworm
Components: stable
END
expect 'lines beside a paragraph of a third party' "$lines"

# Whose packages apt has fetched lists of, it knows. Here an apt-get that knows as much as the test wants.
mkdir "$work/bin"
knows() {
  printf '#!/bin/sh\nprintf "%%s\\n" %s\n' "$(printf "'%s' " "$@")" >"$work/bin/apt-get"
  chmod +x "$work/bin/apt-get"
}
PATH=$work/bin:$PATH
knows 'Debian http://one.example/debian/' 'Some One Else http://two.example/debian/' '$(ORIGIN) http://three.example/debian/'
expect 'one of them is a third party' "$(sed 2d <<<"$lines")"
knows 'A http://one.example/debian/' 'B http://two.example/debian/' 'C http://three.example/debian/'
expect 'only mirrors by other names' "$lines"
knows

rm "$work/sources.list"
cat >"$work/sources.list.d/debian.sources" <<'END'
types: deb deb-src
URIs: http://one.example/debian
 http://two.example/debian
# a word in between
Suites:
 bookworm
 bookworm-updates
Components: main
Architectures: amd64
Signed-By: /usr/share/keyrings/one.gpg

Types: deb
Enabled: no
URIs: http://disabled.example/debian
Suites: bookworm
Components: main

Types: deb-src
URIs: http://source.example/debian
Suites: bookworm
Components: main
END
expect 'paragraphs' 'deb [signed-by=/usr/share/keyrings/one.gpg] http://one.example/debian bookworm main
deb [signed-by=/usr/share/keyrings/one.gpg] http://two.example/debian bookworm main'
echo "apt_sources: passed."
