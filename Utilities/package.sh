#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: package.sh [-j N]
Builds the Debian packages for the Debian that it runs on, from a copy of the sources in
build/debian: meshmorphing has the plugin where ParaView lists it, and morph-mesh;
libmeshmorphing-dev has the headers, the libraries and their CMake package. Prints their paths. The
source package is beside them. Install them with: apt-get install <paths>
Needs the Debian packages build-essential and debhelper (install-packages.sh --package).
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
if ! command -v dh > /dev/null; then
  echo "package.sh: debhelper is missing; Utilities/install-packages.sh --package installs it." >&2
  exit 1
fi

. Utilities/export-sources.sh
folder=$PWD/build/debian
sources=$folder/sources # always the same, for ccache
rm -rf "$folder"
mkdir -p "$sources"
export_sources | tar --extract --directory "$sources"
# Each Debian's packages are of its own ParaView, and an upgrade of Debian brings the next ones.
release=$(. /etc/os-release && echo "+deb${VERSION_ID:-sid}")
sed -i "1s/)/$release)/" "$sources/debian/changelog"
if command -v ccache > /dev/null; then
  # The build has a home of its own.
  CCACHE_DIR=$(ccache --get-config cache_dir)
  export CCACHE_DIR CCACHE_BASEDIR=$sources CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
(cd "$sources" && dpkg-buildpackage --no-sign "--jobs=$jobs" >&2)
rm -rf "$sources"
find "$folder" -name '*.deb'
