#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes a software bill of materials (SPDX 2.3, tag-value): every library the programs load, directly or through another
# one, and every library of which only headers were compiled in, with the Debian package and version it came from.
#   bill-of-materials.sh --name N --version V --headers 'PACKAGE…' --sysroot DIRECTORY --objdump PROGRAM --output FILE PROGRAM…
# An empty --sysroot means this machine; otherwise a sysroot of make-sysroot.sh, with its list of packages.
set -euo pipefail
umask 022  # installed files are readable by all users, independent of the umask

name= version= headers= sysroot= objdump=objdump output= programs=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --name) name=$2 && shift ;;
    --version) version=$2 && shift ;;
    --headers) headers=$2 && shift ;;
    --sysroot) sysroot=$2 && shift ;;
    --objdump) objdump=${2:-objdump} && shift ;;
    --output) output=$2 && shift ;;
    *) programs+=("$1") ;;
  esac
  shift
done
[[ -n $name && -n $output && ${#programs[@]} -gt 0 ]] || {
  echo "usage: bill-of-materials.sh --name N --version V --headers 'PACKAGE…' --sysroot DIRECTORY --objdump PROGRAM" \
    "--output FILE PROGRAM…" >&2
  exit 1
}
if [[ -n $sysroot ]]; then architecture=$(cat "$sysroot/var/lib/dpkg/arch"); else architecture=$(dpkg --print-architecture); fi

die() {
  echo "bill-of-materials: $*" >&2
  exit 1
}

needed_by() { "$objdump" -p "$1" 2>/dev/null | sed -n 's/^ *NEEDED *//p'; }

# Where the loader would find a library.
path_of() {
  local directory
  for directory in "$sysroot"/lib/*-linux-gnu* "$sysroot"/usr/lib/*-linux-gnu* "$sysroot"/lib "$sysroot"/usr/lib; do
    if [[ -e $directory/$1 ]]; then
      echo "$directory/$1"
      return
    fi
  done
}

query() { dpkg-query ${sysroot:+--admindir="$sysroot/var/lib/dpkg"} "$@" 2>/dev/null; }
# package version source, and the names of packages that it provides
describe_package() { query -W -f='${Package} ${Version} ${source:Package} ${Provides}\n' "$1" | head -n 1; }

declare -A seen=() at=() packages=()  # at: the library of each path it may be known by
queue=()
for program in "${programs[@]}"; do
  mapfile -t -O "${#queue[@]}" queue < <(needed_by "$program")
done
while [[ ${#queue[@]} -gt 0 ]]; do
  library=${queue[0]}
  queue=("${queue[@]:1}")
  [[ -z ${seen[$library]:-} ]] || continue
  seen[$library]=yes
  path=$(path_of "$library")
  [[ -n $path ]] || die "$library is in no directory of the loader."
  # What an alternative leads to belongs to a package, its link to none. A package may know the library with or without /usr.
  [[ -n $sysroot || $(readlink "$path") != /etc/alternatives/* ]] || path=$(readlink -f "$path")
  file=${path#"$sysroot"}  # a sysroot's lists name files as they lie there
  for place in "$sysroot$file" "$sysroot/usr$file" "$sysroot${file#/usr}"; do at[$place]=$library; done
  mapfile -t -O "${#queue[@]}" queue < <(needed_by "$path")
done
while IFS= read -r line; do
  library=${at[${line#*: }]}
  [[ ${packages[${line%%: *}]:-} == *"$library "* ]] || packages[${line%%: *}]+="$library "
done < <(query -S "${!at[@]}" || true)  # an error if it knows one of the names only
for library in "${!seen[@]}"; do
  [[ " ${packages[*]} " == *" $library "* ]] || die "no installed package contains $library."
done
for package in $headers; do packages[$package]='(headers) '; done

mkdir -p "$(dirname "$output")"
{
  printf 'SPDXVersion: SPDX-2.3\nDataLicense: CC0-1.0\nSPDXID: SPDXRef-DOCUMENT\n'
  printf 'DocumentName: %s-%s\nDocumentNamespace: urn:stereod:%s:%s:%s\n' "$name" "$version" "$name" "$version" "$architecture"
  printf 'Creator: Tool: bill-of-materials.sh\nCreated: %s\n' \
    "$(date -u -d "@${SOURCE_DATE_EPOCH:-0}" +%Y-%m-%dT%H:%M:%SZ)"
  printf 'Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-%s\n' "$name"
  printf '\nPackageName: %s\nSPDXID: SPDXRef-%s\nPackageVersion: %s\n' "$name" "$name" "$version"
  printf 'PackageDownloadLocation: NOASSERTION\nFilesAnalyzed: false\nPackageLicenseDeclared: BSD-3-Clause\n'
  printf '%s\n' "${!packages[@]}" | LC_ALL=C sort | while read -r key; do
    read -r package package_version source provided < <(describe_package "$key") || continue
    id=SPDXRef-${package//[^A-Za-z0-9.-]/-}
    printf '\nPackageName: %s\nSPDXID: %s\nPackageVersion: %s\n' "$package" "$id" "$package_version"
    printf 'PackageDownloadLocation: NOASSERTION\nFilesAnalyzed: false\nPackageSourceInfo: Debian source package %s\n' "$source"
    # Depends may name what a package provides (libspdlog1.10-fmt9): with the provided names the bill accounts for it.
    printf 'PackageComment: <text>%s%s</text>\n' "${packages[$key]% }" "${provided:+; provides $provided}"
    printf 'Relationship: SPDXRef-%s DEPENDS_ON %s\n' "$name" "$id"
  done
} >"$output"
