#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Prints how many tests passed, failed and were skipped in a JUnit file of ctest. A program that ran as a whole (a shard, named
# test_NAME.NUMBER) is one test to ctest: of it the tests are counted that GoogleTest counts; one that crashed failed once.
#   tests/count_tests.sh FILE.xml
set -euo pipefail
awk '
  function end_shard() { if (shard && crashed) ++failed; shard = 0 }
  function number(line) { match(line, /\] [0-9]+/); return substr(line, RSTART + 2, RLENGTH - 2) }
  /<testcase / {
    end_shard()
    match($0, / name="[^"]*"/)
    name = substr($0, RSTART + 7, RLENGTH - 8)
    match($0, / status="[^"]*"/)
    status = substr($0, RSTART + 9, RLENGTH - 10)
    shard = name ~ /^test_[a-z_]+\.[0-9]+$/
    crashed = shard && status != "run"
    if (shard) next
    if (status == "run") ++passed
    else if (status == "notrun" || status == "disabled") ++skipped
    else ++failed
  }
  shard && /\[  PASSED  \] [0-9]+ test/ { passed += number($0) }
  shard && /\[  SKIPPED \] [0-9]+ test/ { skipped += number($0) }
  shard && /\[  FAILED  \] [0-9]+ test/ { failed += number($0); crashed = 0 }
  END { end_shard(); print passed + 0, failed + 0, skipped + 0 }' "${1:?usage: tests/count_tests.sh FILE.xml}"
