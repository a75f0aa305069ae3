#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the reference of the classes with Doxygen (Debian package doxygen) into
# build/documentation/html. Fails where Doxygen warns, and shows the warnings.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ $# -gt 0 ]; then echo "Usage: check-documentation.sh" >&2; exit 2; fi
output=build/documentation
version=$(sed -n 's/^project(MeshMorphing VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
rm -rf "$output"
mkdir -p "$output"
sed -e "s|@VERSION@|$version|" -e "s|@OUTPUT@|$output|" Documentation/Doxyfile.in \
  > "$output/Doxyfile"
# Headers that are made from templates and the table of properties.
python3 cmake/properties.py cxx "$output/headers"
doxygen "$output/Doxyfile"
if [ -s "$output/warnings.txt" ]; then
  cat "$output/warnings.txt" >&2
  exit 1
fi
echo "No warnings: $PWD/$output/html/index.html"
