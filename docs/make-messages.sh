#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes docs/messages.md from the comments of the .lcm files. --check: shows what is out of date, and fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Prints one file: the comment between package and struct, then a table of its fields. A field without a comment gets the
# comment of the field above.
one_message() {
  awk '
    function escaped(text) { gsub(/\|/, "\\|", text); gsub(/</, "\\&lt;", text); return text }
    /^\/\// { sub(/^\/\/ ?/, ""); about = about (about == "" ? "" : " ") $0; next }
    /^package / { about = ""; next }
    /^struct / {
      name = $2
      printf "\n## %s\n\n%s\n\n| field | type | unit, range and meaning |\n|---|---|---|\n", name, escaped(about)
      next
    }
    # A comment that continues below its field.
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
  echo 'Every message that stereod publishes, field by field.'
  echo '`docs/make-messages.sh` writes this page from the comments of [daemon/lcmtypes](../daemon/lcmtypes).'
  echo 'A channel is the configured prefix (`STEREO` by default) with a suffix:'
  echo
  echo '| channel | type | published |'
  echo '|---|---|---|'
  echo '| `STEREO_DISPARITY` | disparity_rows_t | when rows are final, spread over time by `lcm.pacing` |'
  echo '| `STEREO_FRAME` | frame_t | after the last row of a frame |'
  echo '| `STEREO_CAMERA_INFO` | camera_info_t | once a second and on change |'
  echo '| `STEREO_STATUS` | status_t, with two camera_status_t | once a second |'
  echo '| `STEREO_SCAN` | planar_lidar_t | with `scan.enabled`, once a frame |'
  echo '| `STEREO_DEPTH` | depth_rows_t | with `publish.depth`, after the same disparity rows |'
  echo '| `STEREO_CLOUD` | pointcloud_t | with `publish.cloud`, once a frame |'
  echo '| `STEREO_LEFT` | image_t | with `lcm.left_image` |'
  echo '| `STEREO_LEFT_RAW`, `STEREO_RIGHT_RAW` | image_t | with `lcm.raw_images` |'
  local type
  for type in disparity_rows frame camera_info status camera_status planar_lidar depth_rows pointcloud image image_metadata; do
    one_message "daemon/lcmtypes/stereod_${type}_t.lcm"
  done
}

# A message that is missing in the list above would be undocumented.
count=$(find daemon/lcmtypes -name '*.lcm' | wc -l)
if [[ $count -ne 10 ]]; then
  echo "make-messages.sh: found $count .lcm files, expected the 10 in its list; add the new message to write_all()" >&2
  exit 1
fi

case "${1:-}" in
  '') write_all >docs/messages.md ;;
  --check)
    if ! diff -u docs/messages.md <(write_all); then
      echo "make-messages.sh: docs/messages.md differs from the .lcm files; run docs/make-messages.sh" >&2
      exit 1
    fi
    ;;
  *)
    echo "usage: docs/make-messages.sh [--check]" >&2
    exit 1
    ;;
esac
