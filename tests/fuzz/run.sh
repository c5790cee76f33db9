#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the fuzz targets with clang's libFuzzer and runs each for some seconds. The corpus of earlier runs is in build/corpus.
#   tests/fuzz/run.sh [SECONDS | --build]       SECONDS: for each target, default 20; --build: only build
# Ends with 77, skipped, where there is no clang++-14.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:-20}
[[ $seconds =~ ^[1-9][0-9]*$ || $seconds == --build ]] || {
  echo "usage: tests/fuzz/run.sh [SECONDS | --build]" >&2
  exit 1
}
command -v clang++-14 >/dev/null || {
  echo "fuzz/run.sh: skipped, clang++-14 is missing: toolchain/install-deps.sh --emulation installs it"
  exit 77
}

targets=(fuzz_matcher fuzz_camera_frame fuzz_client)
cmake --preset fuzz -DSTEREOD_CORE_ONLY=OFF
cmake --build build/fuzz -j "$(nproc)" --target "${targets[@]}"
[[ $seconds != --build ]] || exit 0
for target in "${targets[@]}"; do
  mkdir -p "build/corpus/$target"
  log=build/corpus/$target.log
  if build/fuzz/bin/"$target" -max_len=4096 -max_total_time="$seconds" -artifact_prefix="build/corpus/$target-" \
    "build/corpus/$target" >"$log" 2>&1; then
    echo "fuzz/run.sh: $target: $(grep -E '^Done' "$log")"
  else
    tail -n 40 "$log"
    echo "fuzz/run.sh: $target FAILED; the input is in build/corpus, the whole output in $log." >&2
    exit 1
  fi
done
