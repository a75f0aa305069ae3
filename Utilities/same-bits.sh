#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: same-bits.sh [-j N] [--tests] [COMPILER [MORPH_MESH]]
Builds the library and morph-mesh with another compiler, whose warnings are errors, in
build/COMPILER. Then morphs the small models by each method with it and with MORPH_MESH, and fails
where one bit of the nodes differs.
  COMPILER    by default clang++ (Debian package clang)
  MORPH_MESH  by default build/paraview/bin/morph-mesh
  --tests     builds and runs the core's tests with it, too
  -j N        processes to build with (default: all cores)
END
}

jobs=$(nproc)
tests=no
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    --tests) tests=yes ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done
compiler=${1:-clang++}
reference=${2:-build/paraview/bin/morph-mesh}
build=build/$(basename "$compiler")
if [ ! -x "$reference" ]; then
  echo "same-bits.sh: $reference is not there: build the preset paraview first." >&2
  exit 1
fi

testing=OFF
if [ "$tests" = yes ]; then testing=ON; fi
cmake --preset vtk -B "$build" -D CMAKE_CXX_COMPILER="$compiler" \
  -D CMAKE_COMPILE_WARNING_AS_ERROR=ON -D MESHMORPHING_BUILD_TESTING="$testing" \
  -D MESHMORPHING_WRAP_PYTHON=OFF > /dev/null
cmake --build "$build" -j "$jobs" --target morph-mesh
if [ "$tests" = yes ]; then
  cmake --build "$build" -j "$jobs" --target MeshMorphingCoreTests
  ctest --test-dir "$build" --output-on-failure -j "$jobs" -L core
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
methods=$("$reference" --help | sed -n '/--method/,/--set/p' | grep , | grep -v default)
compared=0
# A boundary that is stretched and waved, the same for both.
cat > "$folder/displace.py" <<END
import sys
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

reader = vtk.vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
boundary = reader.GetOutput()
rest = vtk_to_numpy(boundary.GetPoints().GetData())
center = rest.mean(axis=0)
moved = center + (rest - center) * [1.1, 0.95, 1.02] + 0.1 * np.sin(rest[:, [1, 2, 0]])
points = vtk.vtkPoints()
points.SetData(numpy_to_vtk(moved, deep=True))
boundary.SetPoints(points)
writer = vtk.vtkXMLPolyDataWriter()
writer.SetFileName(sys.argv[2])
writer.SetInputData(boundary)
writer.Write()
END
for model in Data/Models/small/*.vtu; do
  "$reference" --quiet --extract-boundary "$model" "$folder/boundary.vtp"
  pvpython "$folder/displace.py" "$folder/boundary.vtp" "$folder/moved.vtp"
  for method in ${methods//,/}; do
    for program in "$reference" "$build/bin/morph-mesh"; do
      # Files of VTK's legacy format are equal exactly where their contents are.
      "$program" --method "$method" --quiet --validity None "$model" "$folder/moved.vtp" \
        "$folder/$(dirname "$program" | tr / _).vtk"
    done
    if ! cmp "$folder"/*.vtk; then
      echo "same-bits.sh: $method differs on $model." >&2
      exit 1
    fi
    compared=$((compared + 1))
  done
done
if [ "$compared" -eq 0 ]; then echo "same-bits.sh: nothing was compared." >&2; exit 1; fi
echo "$compared morphs have the same bits with $compiler."
