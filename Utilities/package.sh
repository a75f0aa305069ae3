#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: package.sh [--from FOLDER] [-j N]
Builds (preset deb) a Debian package with the plugin where ParaView lists it, the headers, the
libraries with their CMake package, and morph-mesh; prints its path. Install it with:
apt-get install <path>
  --from FOLDER  take this build of the preset paraview, so that little is compiled again; it is
                 configured as it was afterwards, and the next build links its programs again
  -j N           processes to build with (default: all cores)
END
}

from=
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --from) shift; from=${1:?"--from needs a folder"} ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if [ -n "$from" ]; then
  # A build that began without ccache goes on without it: with another command all would be compiled
  # again.
  unset CMAKE_CXX_COMPILER_LAUNCHER
  folder=$from
  cached() { sed -n "s/^CMAKE_INSTALL_$1:[A-Z]*=//p" "$folder/CMakeCache.txt"; }
  install_to() { cmake -DCMAKE_INSTALL_PREFIX="$1" -DCMAKE_INSTALL_LIBDIR="$2" "$folder" >&2; }
  prefix=$(cached PREFIX)
  libdir=$(cached LIBDIR)
  # Quiet: the last lines are the error, where there is one.
  trap 'install_to "$prefix" "$libdir" 2> build/restore.log || cat build/restore.log >&2' EXIT
  install_to /usr "lib/$(dpkg-architecture -q DEB_HOST_MULTIARCH)"
else
  if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
  folder=build/deb
  cmake --preset deb >&2
fi
cmake --build "$folder" -j "$jobs" >&2
rm -f "$folder"/*.deb
(cd "$folder" && cpack -G DEB >&2)
ls "$(realpath "$folder")"/*.deb
