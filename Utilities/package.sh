#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: package.sh [-j N]
Builds (preset deb) a Debian package with the plugin where ParaView lists it, the headers, the
libraries with their CMake package, and morph-mesh; prints its path. Install it with:
apt-get install <path>
  -j N   processes to build with (default: all cores)
END
}

jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
cmake --preset deb >&2
cmake --build --preset deb -j "$jobs" >&2
(cd build/deb && rm -f ./*.deb && cpack -G DEB >&2)
ls "$PWD"/build/deb/*.deb
