#!/usr/bin/env bash
# Prints this machine's apt sources of Debian 12 itself, without its updates, for roots and sysroots made with mmdebstrap. Other
# sources need not have every architecture, nor may their packages get in; and what is built against a release's libraries
# runs with their updates too. Fails if there are none.
set -euo pipefail

deb822() {
  local file
  for file in /etc/apt/sources.list.d/*.sources; do
    [[ ! -s $file ]] || awk -v RS= '{
      release = 0
      count = split($0, lines, "\n")
      for (i = 1; i <= count; ++i) if (lines[i] ~ /^Suites:(.*[ \t])?bookworm([ \t]|$)/) { release = 1; lines[i] = "Suites: bookworm" }
      if (release) { for (i = 1; i <= count; ++i) if (lines[i] !~ /^(#|Architectures:)/) print lines[i]; print "" }
    }' "$file"
  done
}
# The older form, one line for each source.
one_line() {
  local file
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [[ ! -s $file ]] || grep -E '^deb[[:space:]]([^#]*[[:space:]])?bookworm[[:space:]]' "$file" || true
  done
}
sources=$(deb822)
[[ -n $sources ]] || sources=$(one_line)
[[ -n $sources ]] || exit 1
printf '%s\n' "$sources"
