#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every option that a program's --help names, its commands' included, is in its manual page.
#   manual_pages.sh DIRECTORY-OF-PROGRAMS
set -euo pipefail
bin=${1:?usage: manual_pages.sh DIRECTORY-OF-PROGRAMS}
pages=$(dirname "${BASH_SOURCE[0]}")/../../docs/man
failed=0
checked=0
"$bin/stereod" --version >/dev/null 2>&1 || [[ $? -ne 126 ]] || {
  echo "manual_pages: the programs are for another architecture: skipped."
  exit 77
}

# options_of PROGRAM [COMMAND]
options_of() { "$@" --help | grep -oE '^  [^ ].*' | grep -oE -- '(^  |,)(-[a-z],)?--[a-z][a-z0-9-]*' | grep -oE -- '--[a-z0-9-]+'; }

check() {
  local page=$1 text option
  shift
  text=$(sed 's/\\-/-/g; s/\\f[BIR]//g' "$page")
  for option in $(options_of "$@"); do
    checked=$((checked + 1))
    grep -qE -- "(^|[^a-z0-9-])$option([^a-z0-9-]|$)" <<<"$text" || {
      echo "$(basename "$page") does not name $option of '${*##*/}'" >&2
      failed=1
    }
  done
}

for page in "$pages"/*.[18]; do
  program=$bin/$(basename "${page%.*}")
  [[ -x $program ]] || continue
  [[ $(file -b --mime-type "$program" 2>/dev/null || true) != text/* ]] || continue
  check "$page" "$program"
  for command in $("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
    check "$page" "$program" "$command"
  done
done
[[ $checked -ge 30 ]] || { echo "only $checked options were found: --help looks otherwise than it did" >&2 && exit 1; }
echo "$checked options"
exit "$failed"
