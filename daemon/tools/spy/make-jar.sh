#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Packs classes into a jar that is the same however often it is made: in the order of their names, with one date.
#   make-jar.sh JAR-PROGRAM FOLDER-OF-CLASSES OUTPUT
set -euo pipefail
jar=$1 classes=$2 output=$3
cd "$classes"
# Without a manifest, which would name the version of Java.
find . -type f -name '*.class' | LC_ALL=C sort >"$output.list"
TZ=UTC "$jar" --create --no-manifest --date=1980-01-01T00:00:02Z --file "$output" @"$output.list"
rm "$output.list"
