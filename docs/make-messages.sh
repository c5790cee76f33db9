#!/usr/bin/env bash
# Writes docs/messages.md from the comments of the .lcm files. With --check: says what is out of date, and fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# One file: the comment above the struct, then a table of its fields. A field without a comment belongs to the one
# above it.
one_message() {
  awk '
    function escaped(text) { gsub(/\|/, "\\|", text); gsub(/</, "\\&lt;", text); return text }
    /^\/\// { sub(/^\/\/ ?/, ""); about = about (about == "" ? "" : " ") $0; next }
    /^package / { next }
    /^struct / {
      name = $2
      printf "\n## %s\n\n%s\n\n| field | type | unit, range and meaning |\n|---|---|---|\n", name, escaped(about)
      next
    }
    # A comment that goes on below its field.
    /^ +\/\// && field != "" {
      sub(/^ *\/\/ ?/, "")
      comment = comment " " $0
      next
    }
    function write_field() {
      if (field != "") printf "| `%s` | %s | %s |\n", field, type, escaped(comment)
      field = ""
    }
    /^}/ { write_field(); next }
    /;/ {
      write_field()
      before = type
      comment = ""
      if (match($0, /\/\/.*/)) comment = substr($0, RSTART + 2)
      gsub(/^ +| +$/, "", comment)
      sub(/\/\/.*/, "")
      sub(/;.*/, "")
      type = $1
      field = $2
      size = field
      if (sub(/^[^[]*/, "", size)) type = type size
      sub(/\[.*/, "", field)
      if (comment == "" && type != before) {
        printf "make-messages.sh: %s: %s has no comment\n", FILENAME, field >"/dev/stderr"
        failed = 1
      }
      if (comment == "") comment = "as above"
    }
    END { exit failed }' "$1"
}

write_all() {
  echo '# The messages'
  echo
  echo 'Made from the comments of [daemon/lcmtypes](../daemon/lcmtypes) by `docs/make-messages.sh`; a test holds it to them. The'
  echo 'channel of each is the configured prefix with an ending: `_DISPARITY` (disparity_rows_t), `_FRAME` (frame_t), `_STATUS`'
  echo '(status_t), `_CAMERA_INFO` (camera_info_t), `_SCAN` (planar_lidar_t), `_DEPTH` (depth_rows_t), `_CLOUD` (pointcloud_t),'
  echo '`_LEFT`, `_LEFT_RAW` and `_RIGHT_RAW` (image_t).'
  local type
  for type in disparity_rows frame camera_info status camera_status planar_lidar depth_rows pointcloud image image_metadata; do
    one_message "daemon/lcmtypes/stereod_${type}_t.lcm"
  done
}

# A message that the list above does not have would go undocumented.
count=$(find daemon/lcmtypes -name '*.lcm' | wc -l)
if [[ $count -ne 10 ]]; then
  echo "make-messages.sh: there are $count messages, and 10 in its list" >&2
  exit 1
fi

case "${1:-}" in
  '') write_all >docs/messages.md ;;
  --check)
    if ! diff -u docs/messages.md <(write_all); then
      echo "make-messages.sh: docs/messages.md is not what the .lcm files say; run docs/make-messages.sh" >&2
      exit 1
    fi
    ;;
  *)
    echo "usage: docs/make-messages.sh [--check]" >&2
    exit 1
    ;;
esac
