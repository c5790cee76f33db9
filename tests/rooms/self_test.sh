#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Shows that tests/rooms/run.sh finds what it is for: each case is a small tree with one fault.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# tree: a tree and a table without fault.
tree() {
  rm -rf "$work/tree"
  mkdir -p "$work/tree"/{core/base,core/match/block,daemon/base,calib/base}
  cd "$work/tree"
  printf '%s\n' '#include <vector>' >core/base/image.h
  printf '%s\n' '#include <immintrin.h>' '#include "core/base/image.h"' >core/match/matcher.h
  printf '%s\n' '#include "core/match/matcher.h"' '#include <unistd.h>' '#include "stereod/status_t.hpp"' >daemon/base/file.cpp
  printf '%s\n' '  #  include "core/match/matcher.h"' '#include <opencv2/core.hpp>' >calib/base/pair.cpp
  printf '%s\n' '#pragma once' >core/match/block/search.h
  cat >table <<'TABLE'
# a table
libraries opencv opencv2/*
libraries intrinsics immintrin.h
libraries posix unistd.h
group all core/base core/match
room core/base
room core/match core/base [intrinsics]
room daemon/lcmtypes
room daemon/base @all daemon/lcmtypes [posix]
room calib/base @all [opencv]
never core <fstream>
never calib core/match/block
TABLE
}
judge() { "$here/run.sh" "$work/tree" table >out 2>&1; }
# finds SENTENCE: the tree as it is now must fail with it.
count=0
finds() {
  count=$((count + 1))
  if judge; then cat out && echo "rooms: FAILED: it should say '$1'" >&2 && exit 1; fi
  grep -qF -- "$1" out || { cat out && echo "rooms: FAILED: it should say '$1'" >&2 && exit 1; }
}

tree
judge || { cat out && echo "rooms: FAILED: a tree without fault is refused" >&2 && exit 1; }

tree && echo 'beside core/base' >>table && echo '#include "image.h"' >core/base/size.cpp
judge || { cat out && echo "rooms: FAILED: an installed header beside its user is refused" >&2 && exit 1; }

tree && echo '#include "daemon/base/file.h"' >>core/match/matcher.h
finds 'core/match/matcher.h:3: core/match must not include daemon/base (daemon/base/file.h)'
tree && echo '#include "core/match/matcher.h"' >>core/base/image.h
finds 'core/base must not include core/match'
tree && echo '#include <opencv2/core.hpp>' >>daemon/base/file.cpp
finds 'daemon/base/file.cpp:4: daemon/base must not include <opencv2/core.hpp> (opencv)'
tree && echo '#include "stereod/status_t.hpp"' >>core/base/image.h
finds 'core/base must not include daemon/lcmtypes'
tree && echo '#include <fstream>' >>core/base/image.h
finds 'core/ must never include <fstream>'
tree && echo '#include "core/match/block/search.h"' >>calib/base/pair.cpp
finds 'calib/ must never include core/match/block'
tree && echo '#include <unknown/unknown.h>' >>daemon/base/file.cpp
finds '<unknown/unknown.h> belongs to no library of the table'
tree && echo '#include "image.h"' >>core/base/image.h
finds '"image.h" is not a path from the root of the tree'
tree && echo 'beside core/base' >>table && echo '#include "gone.h"' >>core/base/image.h
finds '"gone.h" is not a path from the root of the tree'
tree && mkdir core/attic && touch core/attic/old.cpp
finds 'core/attic/old.cpp lies in no room of the table'
tree && echo 'room core/base core/match' >>table && echo '#include "core/match/matcher.h"' >>core/base/image.h
finds 'a circle between rooms in the table: core/base core/match'
tree && echo '#include "core/match/block/search.h"' >>core/match/matcher.h && echo '#include "core/match/matcher.h"' >>core/match/block/search.h
finds 'a circle between headers: core/match/block/search.h core/match/matcher.h'
tree && echo 'room calib/board calib/bsae' >>table
finds 'the table allows calib/bsae, which is no room of it'
echo "rooms: all $count faults were found."
