#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: test.sh [--all] [--no-install] [-j N]
From a bare Debian 12 or 13 to tested builds: installs the packages, builds the plugin, the library
and morph-mesh (build.sh), and runs the tests of core, filters, programs, plugin and window.
  --all         then all else: see test-stages.sh
  --no-install  leave the packages alone
  -j N          processes to build and to test with (default: all cores)
The exit status is 0 if every test passed.
END
}

all=no
install=yes
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --all) all=yes ;;
    --no-install) install=no ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if [ "$install" = yes ]; then Utilities/install-packages.sh; fi
Utilities/build.sh --tests -j "$jobs"
status=0
Utilities/ctest-log.sh build/paraview -j "$jobs" -L '^(core|filters|programs|paraview)$' \
  -LE '^(long|slow|benchmark|mpi|solvers)$' || status=1
echo "Minutes: $(awk -v s=$SECONDS 'BEGIN { printf "%.1f", s / 60 }')"
if [ "$all" = yes ]; then
  options=(-j "$jobs")
  if [ "$install" = no ]; then options+=(--no-install); fi
  Utilities/test-stages.sh "${options[@]}" || status=1
fi
exit $status
