#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Packs classes into a reproducible jar: sorted by name, with a fixed date.
#   make-jar.sh JAR-PROGRAM CLASS-DIRECTORY OUTPUT
set -euo pipefail
jar=$1 classes=$2 output=$3
cd "$classes"
# Without a manifest: it would contain the version of Java.
find . -type f -name '*.class' | LC_ALL=C sort >"$output.list"
TZ=UTC "$jar" --create --no-manifest --date=1980-01-01T00:00:02Z --file "$output" @"$output.list"
rm "$output.list"
