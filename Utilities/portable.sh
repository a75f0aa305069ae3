#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: portable.sh [-j N] [SYSTEM...]
Compiles the core, the readers and writers of solvers' files, and the core's tests for other
systems, and runs the tests. Prints how many files and tests there were, and how many ran. Fails
where one file does not compile or one test does not pass that is not named below.
  SYSTEM  twin (this system, without GNU's vectors), clang, mingw (Windows, by Wine), aarch64
          (by qemu-user), emscripten (by node); by default all five, one after the other
  -j N    processes to compile with (default: all cores)
END
}

jobs=$(nproc)
systems=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    twin | clang | mingw | aarch64 | emscripten) systems+=("$1") ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done
if [ ${#systems[@]} -eq 0 ]; then systems=(twin clang mingw aarch64 emscripten); fi

# Sets compiler, flags and program for a system, and the tests that it leaves out.
system() {
  left_out=()
  cmake=(-DCMAKE_SYSTEM_NAME=Linux)
  flags=()
  link=()
  program=tests
  case "$1" in
    twin)
      compiler=g++
      flags=(-DMORPH_SCALAR_SIMD)
      run=() ;;
    clang)
      compiler=clang++
      run=() ;;
    mingw)
      compiler=x86_64-w64-mingw32-g++-posix
      cmake=(-DCMAKE_SYSTEM_NAME=Windows)
      # GCC does not align the stack for wide vectors there (its bug 54412): the twin has none.
      flags=(-D_USE_MATH_DEFINES -DMORPH_SCALAR_SIMD -Wa,-mbig-obj)
      link=(-static)
      program=tests.exe
      run=(env WINEDEBUG=-all WINEPREFIX="$PWD/build/portable/wine" /usr/lib/wine/wine64) ;;
    aarch64)
      compiler=aarch64-linux-gnu-g++
      link=(-static)
      run=(qemu-aarch64) ;;
    emscripten)
      compiler=em++
      left_out=(Parallel.AThreadTakesAtLeastTheGrain) # there is one thread
      cmake=(-DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
      flags=(-fexceptions -DCGAL_ALWAYS_ROUND_TO_NEAREST)
      link=(-sALLOW_MEMORY_GROWTH -sTOTAL_STACK=8MB -sWASM_ASYNC_COMPILATION=0 -sNODERAWFS
        -sEXIT_RUNTIME)
      program=tests.js
      run=(env NODE_PATH=/usr/share/nodejs node) ;;
  esac
}

# Deals the test suites out to processes, and counts what became of the tests.
run_tests() {
  local program=build/portable/$1/$program logs=build/portable/$1/logs all suites filter i k
  all=$("${run[@]}" "$program" --gtest_list_tests | tr -d '\r')
  readarray -t suites < <(sed -n 's/^\([A-Za-z0-9_/]*\.\).*/\1/p' <<<"$all")
  rm -rf "$logs"
  mkdir "$logs"
  for ((i = 0; i < 4 * jobs; ++i)); do
    filter=
    for ((k = i; k < ${#suites[@]}; k += 4 * jobs)); do filter+=":${suites[k]}*"; done
    if [ "$i" -ge "$jobs" ]; then wait -n || true; fi
    "${run[@]}" "$program" --gtest_filter="$filter-$(IFS=:; echo "${left_out[*]}")" \
      >"$logs/$i" 2>&1 &
  done
  wait
  for i in "${left_out[@]}"; do echo "$1: left out: $i"; done
  cat "$logs"/* | tr -d '\r' |
    awk -v name="$1" -v all="$(grep -c '^  ' <<<"$all")" -v left_out=${#left_out[@]} '
      function end_of_process() { if (runs != "") print name ": ended early: " runs }
      /^\[ RUN      \]/ { end_of_process(); runs = $4 }
      /\[       OK \].* ms\)$/ { ++passed; runs = "" }
      /\[  SKIPPED \].* ms\)$/ { ++skipped; runs = "" }
      /\[  FAILED  \].* ms\)$/ { print name ": failed: " runs; runs = "" }
      END {
        end_of_process()
        printf "%s: of %d tests, %d pass, %d skip themselves, %d are left out\n",
          name, all, passed, skipped, left_out
        exit passed + skipped + left_out != all
      }'
}

failed=0
for name in "${systems[@]}"; do
  system "$name"
  if ! command -v "$compiler" >/dev/null; then
    echo "portable.sh: there is no $compiler; see install-packages.sh --portable." >&2
    exit 1
  fi
  build=build/portable/$name
  # Headers alone, so that those of this system's C library stay out.
  mkdir -p "$build/include"
  for header in CGAL boost fast_float fmt nanoflann.hpp eigen3/Eigen eigen3/unsupported; do
    ln -sfn "/usr/include/$header" "$build/include/$(basename "$header")"
  done
  cmake -S Testing/Portable -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None "${cmake[@]}" \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="${flags[*]}" \
    -DCMAKE_EXE_LINKER_FLAGS="${link[*]}" -DPORTABLE_HEADERS="$PWD/$build/include" \
    >"$build/configure.log"
  sed -n "s/^-- \([0-9]* sources of\)/$name: \1/p" "$build/configure.log"
  if ! ninja -C "$build" -j "$jobs" -k 0 >"$build/build.log" 2>&1; then
    echo "$name: these do not compile, or the tests do not link; see $build/build.log"
    sed -n 's/^FAILED: \([^ ]*\).*/  \1/p' "$build/build.log"
    failed=1
    continue
  fi
  echo "$name: all are compiled"
  run_tests "$name" || failed=1
  python3 Testing/Programs/move_surface.py "${run[@]}" "$build/${program/tests/move-surface}" ||
    failed=1
done
exit $failed
