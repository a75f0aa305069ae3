#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: lint.sh [-p BUILD] [-j N] [FILE...]
Runs clang-tidy (Debian package clang-tidy) by .clang-tidy over the sources of Filters and Programs,
or over FILE...; fails where it finds something.
  -p BUILD   a configured build folder of VTK mode; by default build/lint, which is configured first
  -j N       processes (default: all cores)
END
}

build=build/lint
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    -p) shift; build=${1:?"-p needs a folder"} ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done

cmake --preset vtk -B "$build" -D CMAKE_EXPORT_COMPILE_COMMANDS=ON > /dev/null
files=("$@")
if [ ${#files[@]} -eq 0 ]; then
  mapfile -t files < <(find Filters Programs -name '*.cxx' | sort)
fi
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy -p "$build" --quiet
echo "clang-tidy finds nothing in ${#files[@]} files."
