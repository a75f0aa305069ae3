#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: build.sh [--tests] [-j N] [TARGET...]
Builds the plugin, the library and morph-mesh in build/paraview (preset paraview), from nothing as
fast as that goes: sources are compiled by tens. Once tests are configured there, they stay.
  TARGET   only this, such as MeshMorphing: the plugin
  --tests  also the tests of core, filters, programs, plugin and window
  -j N     processes (default: all cores)
END
}

testing=()
jobs=$(nproc)
targets=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --tests) testing=(-DMESHMORPHING_BUILD_TESTING=ON -DMESHMORPHING_TEST_GROUPS="") ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    -*) usage >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done
if [ ! -e build/paraview/CMakeCache.txt ] && [ ${#testing[@]} -eq 0 ]; then
  testing=(-DMESHMORPHING_BUILD_TESTING=OFF)
fi
if command -v ccache > /dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  # The presets share what they compile alike, such as the core, whatever their build folder is.
  export CCACHE_BASEDIR=$PWD
fi
cmake --preset paraview -DMESHMORPHING_UNITY_BUILD=ON ${testing[@]+"${testing[@]}"}
cmake --build --preset paraview -j "$jobs" ${targets[@]+--target "${targets[@]}"}
