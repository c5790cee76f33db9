#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Reads the includes of core/, daemon/ and calib/ and fails on each that the table of rooms does not allow, on a circle
# between rooms, on a circle between headers, and on a source outside all rooms. Prints the rooms with their sizes.
#   tests/rooms/run.sh [TREE [TABLE]]        default: this tree and tests/rooms/rooms.txt
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(cd "${1:-$here/../..}" && pwd)
table=$(realpath "${2:-$here/rooms.txt}")
cd "$tree"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
find core daemon calib \( -name '*.h' -o -name '*.cpp' -o -name '*.h.in' \) -type f 2>/dev/null | LC_ALL=C sort >"$work/files"
[[ -s $work/files ]] || { echo "rooms: no sources in $tree" >&2 && exit 1; }
# "FILE:LINE:#include …" of all sources.
xargs -d '\n' grep -HnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*["<]' <"$work/files" >"$work/includes" || true

# Judges every include. Leaves the allowed arrows between rooms and the arrows between headers for tsort.
failures=0
awk -v allowed_out="$work/allowed" -v headers_out="$work/headers" -v sizes_out="$work/sizes" '
  function fail(text) { print "rooms: " text; ++failures }
  # The words of a line from field i on, groups replaced.
  function expand(i,   words, n, k, inner) {
    words = ""
    for (; i <= NF; ++i) {
      if ($i ~ /^@/) {
        if (!(substr($i, 2) in group)) fail("the table has no group " $i)
        words = words " " group[substr($i, 2)]
      } else {
        words = words " " $i
      }
    }
    return words
  }
  function room_of(path) {
    while (path != "" && !(path in is_room)) {
      if (!sub(/\/[^\/]*$/, "", path)) path = ""
    }
    return path
  }
  function begins(path, start) { return path == start || index(path, start "/") == 1 }
  # The library that a header in angle brackets belongs to; empty: none that the table knows.
  function library_of(header,   i) {
    if (header !~ /[\/.]/) return "std"
    for (i = 1; i <= patterns; ++i) if (header ~ pattern[i]) return library[i]
    return ""
  }
  FILENAME == ARGV[1] {
    if (/^[ \t]*(#|$)/) next
    if ($1 == "libraries") {
      for (i = 3; i <= NF; ++i) {
        regex = $i
        gsub(/\./, "\\.", regex)
        gsub(/\*/, ".*", regex)
        pattern[++patterns] = "^" regex "$"
        library[patterns] = $2
      }
    } else if ($1 == "group") {
      group[$2] = expand(3)
    } else if ($1 == "beside") {
      for (i = 2; i <= NF; ++i) beside[$i] = 1
    } else if ($1 == "never") {
      never[++nevers] = $2
      never_what[nevers] = expand(3)
    } else if ($1 == "room") {
      is_room[$2] = 1
      rooms[++room_count] = $2
      count = split(expand(3), words, " ")
      inside = 0
      for (i = 1; i <= count; ++i) {
        word = words[i]
        if (sub(/^\[/, "", word)) inside = 1
        last = sub(/\]$/, "", word)
        if (inside) {
          uses[$2, word] = 1
        } else {
          may[$2, word] = 1
          named[word] = 1
          print $2, word >allowed_out
        }
        if (last) inside = 0
      }
    } else {
      fail("the table has a line that begins with " $1)
    }
    next
  }
  FNR == 1 { for (word in named) if (!(word in is_room)) fail("the table allows " word ", which is no room of it") }
  FILENAME == ARGV[2] {
    file_room = room_of($0)
    exists[$0] = 1
    if (file_room == "") fail($0 " lies in no room of the table")
    ++files[file_room]
    next
  }
  {
    match($0, /:[0-9]+:/)
    file = substr($0, 1, RSTART - 1)
    place = file ":" substr($0, RSTART + 1, RLENGTH - 2)
    rest = substr($0, RSTART + RLENGTH)
    match(rest, /["<][^">]*[">]/)
    header = substr(rest, RSTART + 1, RLENGTH - 2)
    bracket = substr(rest, RSTART, 1) == "<"
    from = room_of(file)
    if (from == "") next
    for (i = 1; i <= nevers; ++i) {
      if (!begins(file, never[i])) continue
      count = split(never_what[i], words, " ")
      for (k = 1; k <= count; ++k) {
        if (words[k] == "<" header ">" || (words[k] !~ /^</ && begins(header, words[k])))
          fail(place ": " never[i] "/ must never include " words[k] " (" header ")")
      }
    }
    if (begins(header, "stereod")) header_room = "daemon/lcmtypes"  # generated of the .lcm files
    else if (header ~ /^(core|daemon|calib)\//) header_room = room_of(header)
    else header_room = ""
    if (header_room != "") {
      if (header in exists && file ~ /\.h$/) print file, header >headers_out
      if (header_room != from && !((from SUBSEP header_room) in may))
        fail(place ": " from " must not include " header_room " (" header ")")
      next
    }
    if (header ~ /^(core|daemon|calib)\//) { fail(place ": " header " lies in no room of the table"); next }
    if (!bracket && from in beside && header !~ /\//) {
      sibling = file
      sub(/[^\/]*$/, "", sibling)
      if ((sibling header) in exists) {
        if (file ~ /\.h$/) print file, sibling header >headers_out
        next
      }
    }
    if (!bracket) { fail(place ": \"" header "\" is not a path from the root of the tree"); next }
    name = library_of(header)
    if (name == "") fail(place ": <" header "> belongs to no library of the table")
    else if (name != "std" && !((from SUBSEP name) in uses)) fail(place ": " from " must not include <" header "> (" name ")")
  }
  END {
    for (i = 1; i <= room_count; ++i) print rooms[i], files[rooms[i]] + 0 >sizes_out
    exit failures > 0
  }' "$table" "$work/files" "$work/includes" || failures=1

# tsort names the members of a circle on its error output.
circle_in() {
  local file=$1 what=$2
  [[ -s $file ]] || return 0
  if ! tsort "$file" >/dev/null 2>"$work/circle"; then
    echo "rooms: a circle between $what: $(sed -n 's/^tsort: //p' "$work/circle" | grep -v 'input contains' | LC_ALL=C sort | tr '\n' ' ')"
    failures=1
  fi
}
circle_in "$work/allowed" "rooms in the table"
circle_in "$work/headers" "headers"

if [[ $failures -ne 0 ]]; then
  echo "rooms: FAILED. What each room may include is in tests/rooms/rooms.txt; what two rooms need lives in the room below both."
  exit 1
fi
while read -r room count; do
  [[ $count -gt 0 ]] || continue
  printf '%-22s %4d files\n' "$room" "$count"
done <"$work/sizes"
echo "rooms: every include runs downward."
