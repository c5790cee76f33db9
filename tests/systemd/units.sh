#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The units: how exposed systemd finds the services, that the template is the service under another name, and that the
# example for real time stays as strict as it can. Ends with 77, skipped, where there is no systemd-analyze.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

fail() {
  echo "units: $*" >&2
  exit 1
}

command -v systemd-analyze >/dev/null || {
  echo "units: no systemd-analyze here: skipped."
  exit 77
}

# exposure UNIT: as a number.
exposure() {
  systemd-analyze security --offline=true --no-pager "$1" | sed -n 's/.*Overall exposure level for .*: \([0-9.]*\) .*/\1/p'
}

# check_exposure UNIT MAXIMUM: fails above it.
check_exposure() {
  local found
  found=$(exposure "$1")
  [[ -n $found ]] || fail "systemd-analyze prints no exposure of $1"
  echo "units: $(basename "$1") exposure $found (limit $2)"
  awk -v found="$found" -v maximum="$2" 'BEGIN { exit !(found <= maximum) }' || fail "$1 is too exposed"
}

check_exposure systemd/stereod.service 1.5
check_exposure systemd/stereod@.service 1.5
check_exposure systemd/stereod-multicast.service 2

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Offline a drop-in is not read; as a part of the unit it means the same.
{
  sed '/^\[Install\]/,$d' systemd/stereod.service
  grep -v '^\[' systemd/examples/realtime.conf
} >"$scratch/stereod.service"
check_exposure "$scratch/stereod.service" 1.5

# What is known to differ is made the same.
sed -e 's/ (%i)//' -e 's#/etc/stereod/%i.yaml#/etc/stereod/stereod.yaml#' -e 's#^StateDirectory=stereod/%i#StateDirectory=stereod#' \
  -e '/^#/d' systemd/stereod@.service >"$scratch/template"
diff <(sed '/^#/d' systemd/stereod.service) "$scratch/template" || fail "stereod@.service is not stereod.service under another name"

# Unknown keys and unreadable values. Programs that are installed elsewhere, or not yet, are no concern of the units.
for unit in systemd/*.service; do
  complaints=$(systemd-analyze verify --man=no --recursive-errors=no "$unit" 2>&1 |
    grep "$(basename "$unit")" | grep -v 'is not executable' || true)
  [[ -z $complaints ]] || fail "$complaints"
done
echo "units: OK"
