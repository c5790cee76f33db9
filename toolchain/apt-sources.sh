#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Prints this machine's apt sources of Debian 12 itself, without its updates, one a line, for roots and sysroots made with
# mmdebstrap or apt. Other sources need not have every architecture, nor may their packages get in; and what is built against
# a release's libraries runs with their updates too. Fails if there are none.
#   apt-sources.sh [DIRECTORY]      DIRECTORY: instead of /etc/apt
set -euo pipefail
directory=${1:-/etc/apt}

# The form with a paragraph for each source. Field names are in any case, values go on in indented lines.
paragraphs() {
  local file
  for file in "$directory"/sources.list.d/*.sources; do
    [[ ! -s $file ]] || awk -v RS= '
      function has(list, word) { return (" " list " ") ~ ("[ \t]" word "[ \t]") }
      {
        split("", field)
        name = ""
        count = split($0, lines, "\n")
        for (i = 1; i <= count; ++i) {
          if (lines[i] ~ /^#/) continue
          if (lines[i] ~ /^[^ \t:]+:/) {
            name = tolower(substr(lines[i], 1, index(lines[i], ":") - 1))
            sub(/^[^:]*:/, "", lines[i])
          }
          field[name] = field[name] " " lines[i]
        }
        if (!has(field["types"], "deb") || tolower(field["enabled"]) ~ /no|false|without|off|disable/) next
        if (!has(field["suites"], "bookworm") || !has(field["components"], "main")) next
        options = ""
        key = field["signed-by"]
        gsub(/^[ \t]+|[ \t]+$/, "", key)
        if (key ~ /^[^ \t]+$/) options = options " signed-by=" key  # not where the key itself stands there
        if (tolower(field["trusted"]) ~ /yes/) options = options " trusted=yes"
        uris = split(field["uris"], uri)
        components = field["components"]
        gsub(/[ \t]+/, " ", components)
        for (i = 1; i <= uris; ++i) print "deb " (options == "" ? "" : "[" substr(options, 2) "] ") uri[i] " bookworm" components
      }' "$file"
  done
}

# The older form, a line for each source, whose options may limit it to an architecture.
lines() {
  local file
  for file in "$directory"/sources.list "$directory"/sources.list.d/*.list; do
    [[ ! -s $file ]] || sed -E -n 's/[[:space:]]*(#.*)?$//
      /^[[:space:]]*deb[[:space:]]/!d
      s/\[[[:space:]]*/[/; s/([[[:space:]])arch[-+]?=[^][:space:]]*[[:space:]]*/\1/g; s/[[:space:]]*\]/]/; s/\[\][[:space:]]*//
      s/[[:space:]]+/ /g; s/^ //
      / bookworm (.* )?main( |$)/p' "$file"
  done
}

# Prints the third-party sources that apt knows, by the package lists it has fetched.
others() {
  apt-get indextargets --format '$(ORIGIN) $(REPO_URI)' 'Created-By: Packages' 2>/dev/null |
    awk '$1 ~ /^[$]/ || ($1 == "Debian" && NF == 2) { next } { print $NF }' | sort -u
}

sources=$({ paragraphs && lines; } | awk '!seen[$0]++')
own=$sources
while IFS= read -r uri; do
  [[ -z $uri ]] || own=$(awk -v uri="${uri%/}" '{ for (i = 1; i <= NF; ++i) if ($i == uri || $i == uri "/") next; print }' <<<"$own")
done < <(others)
# A mirror of Debian may call itself by another name; where nothing else is there, it is meant.
[[ -z $own ]] || sources=$own
[[ -n $sources ]] || exit 1
printf '%s\n' "$sources"
