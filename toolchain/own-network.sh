#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs a command in a network namespace with nothing but loopback, which carries multicast. LCM works there on every
# machine, no message leaves it, and other LCM traffic is not disturbed. Needs no privileges, only a kernel that lets users
# create namespaces.
#
#   own-network.sh COMMAND [ARGUMENT…]
#   own-network.sh --possible            succeeds if a namespace can be created here; prints nothing
set -euo pipefail

set_up='ip link set lo up && ip route add 224.0.0.0/4 dev lo'

# -r: a user may make a network only where he is root. Where that is forbidden, root himself may still do without.
find_unshare() {
  local flags
  for flags in -rn -n; do
    if unshare "$flags" sh -c "$set_up" >/dev/null 2>&1; then
      printf '%s\n' "$flags"  # echo would take -n for its own
      return 0
    fi
  done
  return 1
}

if ! flags=$(find_unshare); then
  [[ ${1:-} == --possible ]] || echo "own-network: this machine does not allow network namespaces." >&2
  exit 1
fi
[[ ${1:-} != --possible ]] || exit 0
exec unshare "$flags" sh -c "$set_up"' && exec "$@"' sh "$@"
