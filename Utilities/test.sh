#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: test.sh [--no-install] [--no-asan] [-j N]
From a bare Debian 12 to tested builds: installs the packages, builds the plugin (preset paraview) and runs the tests
labelled core, filters and paraview; then builds with sanitizers (preset asan) and runs core and filters.
CTest's summaries come last. The exit status is 0 if every test passed.
  --no-install   leave the packages alone
  --no-asan      leave the sanitizers out
  -j N           processes to build and to test with (default: all cores)
END
}

install=yes
presets=(paraview asan)
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --no-install) install=no ;;
    --no-asan) presets=(paraview) ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if [ "$install" = yes ]; then Utilities/install-packages.sh; fi
if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

status=0
for preset in "${presets[@]}"; do
  cmake --preset "$preset"
  cmake --build --preset "$preset" -j "$jobs"
  ctest --preset "$preset" -j "$jobs" 2>&1 | tee "build/$preset/ctest.log" || status=1
done
for preset in "${presets[@]}"; do
  echo
  echo "== preset $preset"
  sed -n '/ tests passed/,$p' "build/$preset/ctest.log"
done
exit $status
