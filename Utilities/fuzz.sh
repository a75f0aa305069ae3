#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: fuzz.sh [--cases N] [--from SEED] [--preset NAME] [-j N]
Builds MeshMorphingFuzz and runs random cases through all filters, in blocks of 2,000 seeds.
A run that was ended goes on where it was: build/fuzz has a folder for each preset and commit,
with a report for each finished block. Prints the seeds, the findings and the minutes; the exit
status is 0 if nothing was found.
  --cases N      default 1000000
  --from SEED    the first seed, a multiple of 2,000, default 0
  --preset NAME  vtk (default: fast, and with the assertions of ParaView's VTK), asan (slower, with
                 sanitizers) or another
  -j N           processes (default: all cores)
END
}

cases=1000000
from=0
preset=vtk
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --cases) shift; cases=${1:?"--cases needs a number"} ;;
    --from) shift; from=${1:?"--from needs a seed"} ;;
    --preset) shift; preset=${1:?"--preset needs a name"} ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

program=build/$preset/bin/MeshMorphingFuzz
if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
cmake --preset "$preset" > /dev/null
cmake --build --preset "$preset" -j "$jobs" --target MeshMorphingFuzz

export block=2000 program
state=build/fuzz/$preset-$(git rev-parse --short HEAD 2> /dev/null || echo tree)
mkdir -p "$state"
export state
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
start=$(date +%s)
run_block() {
  if [ -e "$state/$1.txt" ]; then return; fi
  nice "$program" --from "$1" --count "$block" > "$state/$1.part" || true
  # Without its last lines a report is of a run that was ended.
  if grep -q '^Seeds ' "$state/$1.part"; then mv "$state/$1.part" "$state/$1.txt"; fi
}
export -f run_block
seq "$from" "$block" $((from + cases - 1)) | xargs -P "$jobs" -I{} bash -c 'run_block {}'

finished=0
findings=0
for first in $(seq "$from" "$block" $((from + cases - 1))); do
  if [ -e "$state/$first.txt" ]; then
    finished=$((finished + block))
    findings=$((findings + $(grep -c '^FINDING' "$state/$first.txt" || true)))
  fi
done
echo "Seeds $from to $((from + cases - 1)), preset $preset: $finished cases finished," \
  "$findings findings, $((($(date +%s) - start + 30) / 60)) minutes in this run. Reports: $state"
if [ "$findings" -gt 0 ]; then grep -h '^FINDING' "$state"/*.txt | head -n 50; fi
[ "$findings" -eq 0 ] && [ "$finished" -ge "$cases" ]
