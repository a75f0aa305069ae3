#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: plain-vtk.sh [--unpack-only] [-j N]
Builds and tests the VTK library and the Python module with Debian's own VTK: 9.1 on Debian 12, 9.3
on Debian 13. Its packages cannot be installed beside ParaView's Python, so they are downloaded and
unpacked (about 35 MB and 200 MB) into build/debian-vtk. Then the preset plain-vtk is configured,
built and tested there. The exit status is 0 if every test passed.
  --unpack-only  stop before configuring
  -j N           processes to build and to test with (default: all cores)
END
}

unpack_only=no
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --unpack-only) unpack_only=yes ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

release=$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}")
case "$release" in
  "debian 12") versioned=(libvtk9.1 libvtk9.1-qt libjsoncpp25) ;;
  "debian 13") versioned=(libvtk9.3 libvtk9.3-qt libjsoncpp26) ;;
  *) echo "plain-vtk.sh: written for Debian 12 and 13, this is '$release'." >&2; exit 2 ;;
esac
# VTK's CMake files check that every library and wrapper of VTK is there, and look for TBB (its
# threads) and JsonCpp.
packages=(libvtk9-dev libvtk9-java python3-vtk9 vtk9 libtbb-dev libtbb12 libtbbmalloc2
  libtbbbind-2-5 libjsoncpp-dev "${versioned[@]}")
folder=build/debian-vtk
if [ ! -e "$folder/complete" ]; then
  rm -rf "$folder"
  mkdir -p "$folder/packages"
  if ! apt-cache show "${packages[@]}" > /dev/null 2>&1; then
    if [ "$(id -u)" -eq 0 ]; then apt-get update; else sudo apt-get update; fi
  fi
  (cd "$folder/packages" && apt-get -o APT::Sandbox::User="$(id -un)" -o Acquire::Retries=3 \
    download "${packages[@]}")
  for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$folder"; done
  rm -r "$folder/packages"
  touch "$folder/complete"
fi
if [ "$unpack_only" = yes ]; then exit 0; fi

if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
cmake --preset plain-vtk -DMESHMORPHING_UNITY_BUILD=ON -DMESHMORPHING_TEST_GROUPS="fuzz;soak"
cmake --build --preset plain-vtk -j "$jobs"
Utilities/ctest-log.sh build/plain-vtk -j "$jobs" -LE '^(slow|benchmark|core)$' # it knows no VTK
