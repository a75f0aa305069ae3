#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: build-for.sh PARAVIEW_DIR [CMake option...]
Builds the plugin for another ParaView than Debian's, 5.11 to 6.1: into build/for-<version>.
PARAVIEW_DIR: a build tree of ParaView, an install prefix with its headers, or the folder of
ParaViewConfig.cmake. A download without headers is none of these.
Compiler and libraries must be those that ParaView was built with; CC, CXX and the options say so,
as in -DCMAKE_CXX_COMPILER=g++-12.
END
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  "" | -*) usage >&2; exit 2 ;;
esac
paraview=$1
shift
if [ ! -d "$paraview" ]; then echo "build-for.sh: there is no folder $paraview" >&2; exit 2; fi

# The folder itself, a build tree's, an install prefix's, Debian's.
config=
for folder in "$paraview" "$paraview"/lib*/cmake/paraview-* "$paraview"/lib/*/cmake/paraview-*; do
  for name in ParaViewConfig.cmake paraview-config.cmake; do
    if [ -z "$config" ] && [ -e "$folder/$name" ]; then config=$(cd "$folder" && pwd); fi
  done
done
if [ -z "$config" ]; then
  echo "build-for.sh: $paraview has no ParaViewConfig.cmake or paraview-config.cmake: take a" \
    "build tree, or an install with headers (a download of Kitware's has none)" >&2
  exit 1
fi

# Results of an earlier try are no use: another ParaView may stand in the same place.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cat > "$scratch/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.18)
project(version LANGUAGES C CXX)
include($PWD/cmake/DebianParaView.cmake)
find_package(ParaView REQUIRED)
file(WRITE "\${CMAKE_BINARY_DIR}/version" "\${ParaView_VERSION}")
END
if ! cmake -S "$scratch" -B "$scratch/build" -G Ninja -DParaView_DIR="$config" "$@" \
  > "$scratch/log" 2>&1; then
  cat "$scratch/log" >&2
  exit 1
fi
version=$(cat "$scratch/build/version")
build=build/for-$version
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DMESHMORPHING_BUILD_PARAVIEW_PLUGIN=ON \
  -DMESHMORPHING_BUILD_TESTING=OFF -DParaView_DIR="$config" "$@"
cmake --build "$build"
echo "For ParaView $version:"
find "$PWD/$build" -name MeshMorphing.so
