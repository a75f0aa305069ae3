#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: portable.sh [-j N] [--install] [SYSTEM...]
Compiles the core, the readers and writers of solvers' files, and the core's tests for other
systems, and runs the tests. Prints how many files and tests there were, and how many ran. Fails
where one file does not compile or one test does not pass that is not named below.
  SYSTEM     mingw (Windows, by Wine), aarch64 (by qemu-user), clang, emscripten (by node);
             by default all four, one after the other
  --install  installs the Debian packages that they need first
  -j N       processes to compile with (default: all cores)
END
}

jobs=$(nproc)
install=no
systems=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    --install) install=yes ;;
    mingw | aarch64 | clang | emscripten) systems+=("$1") ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done
if [ ${#systems[@]} -eq 0 ]; then systems=(clang mingw aarch64 emscripten); fi

# Sets compile, link and run for a system, its packages, and the tests that it leaves out.
system() {
  left_out=()
  flags=(-std=c++17 -O1 -DNDEBUG -DCGAL_DISABLE_GMP -fno-math-errno)
  link=()
  case "$1" in
    clang)
      packages=(clang)
      compiler=clang++
      run=() ;;
    mingw)
      packages=(g++-mingw-w64-x86-64-posix wine64)
      compiler=x86_64-w64-mingw32-g++-posix
      flags+=(-D_USE_MATH_DEFINES -Wa,-mbig-obj)
      link=(-static)
      run=(wine64) ;;
    aarch64)
      packages=(g++-aarch64-linux-gnu qemu-user)
      compiler=aarch64-linux-gnu-g++
      link=(-static)
      run=(qemu-aarch64) ;;
    emscripten)
      packages=(emscripten)
      compiler=em++
      flags+=(-fexceptions -DCGAL_ALWAYS_ROUND_TO_NEAREST)
      link=(-fexceptions -sALLOW_MEMORY_GROWTH -sSTACK_SIZE=8MB -sWASM_ASYNC_COMPILATION=0 -sNODERAWFS -sEXIT_RUNTIME)
      run=(env NODE_PATH=/usr/share/nodejs node) ;;
  esac
}

# Headers alone, so that those of the host's C library stay out.
headers() {
  local folder=$1
  mkdir -p "$folder"
  ln -sfn /usr/include/CGAL "$folder/CGAL"
  ln -sfn /usr/include/boost "$folder/boost"
  ln -sfn /usr/include/nanoflann.hpp "$folder/nanoflann.hpp"
  ln -sfn /usr/include/eigen3/Eigen "$folder/Eigen"
  ln -sfn /usr/include/eigen3/unsupported "$folder/unsupported"
}

failed=0
for name in "${systems[@]}"; do
  system "$name"
  if [ "$install" = yes ]; then
    apt-get install -y --no-install-recommends googletest "${packages[@]}" >/dev/null
  fi
  if ! command -v "$compiler" >/dev/null; then
    echo "portable.sh: $name needs ${packages[*]}: call it with --install." >&2
    exit 1
  fi
  build=build/portable/$name
  mkdir -p "$build"
  headers "$build/include"
  replace=ReplaceFile
  if [ "$name" = mingw ]; then replace=ReplaceFileWindows; fi
  sources=$(
    find Filters/Core -name '*.cxx'
    find Filters/IO/Text Filters/IO/Files Filters/IO/Formats -name '*.cxx' \
      ! -name 'ReplaceFile*' ! -name NetCdf.cxx ! -name CgnsTree.cxx
    echo "Filters/IO/Files/$replace.cxx"
    find Testing/Core -name '*.cxx'
    echo /usr/src/googletest/googletest/src/gtest-all.cc
    echo /usr/src/googletest/googletest/src/gtest_main.cc
  )
  compile=("$compiler" "${flags[@]}" -isystem "$build/include" -isystem /usr/src/googletest/googletest/include
    -isystem /usr/src/googletest/googletest -IFilters/Core -IFilters/IO -ITesting/Core)
  if command -v ccache >/dev/null; then compile=(ccache "${compile[@]}"); fi
  # One object a source; a failure leaves none.
  one() {
    local source=$1 object
    object=$build/$(echo "$source" | tr / _).o
    if [ ! -e "$object" ] || [ "$source" -nt "$object" ]; then
      "${compile[@]}" -c "$source" -o "$object" 2>"$object.log" || { rm -f "$object"; return 0; }
    fi
  }
  running=0
  for source in $sources; do
    one "$source" &
    running=$((running + 1))
    if [ "$running" -ge "$jobs" ]; then wait -n; running=$((running - 1)); fi
  done
  wait
  objects=()
  count=0
  for source in $sources; do
    count=$((count + 1))
    object=$build/$(echo "$source" | tr / _).o
    if [ -e "$object" ]; then objects+=("$object"); else echo "$name: $source does not compile: $object.log"; fi
  done
  echo "$name: ${#objects[@]} of $count files compile"
  program=$build/tests
  if [ "$name" = mingw ]; then program+=.exe; fi
  if [ "$name" = emscripten ]; then program+=.js; fi
  if [ "${#objects[@]}" -ne "$count" ] ||
    ! "$compiler" "${objects[@]}" "${link[@]}" -o "$program" 2>"$build/link.log"; then
    echo "$name: no tests ran: $build/link.log"
    failed=1
    continue
  fi
  filter="-$(IFS=:; echo "${left_out[*]}")"
  "${run[@]}" "$program" --gtest_filter="$filter" --gtest_brief=1 >"$build/tests.log" 2>&1 || failed=1
  grep -aE 'tests? from|PASSED|FAILED' "$build/tests.log" | sed "s/^/$name: /" || failed=1
  for test in "${left_out[@]}"; do echo "$name: left out: $test"; done
done
exit $failed
