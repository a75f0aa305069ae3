#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

# Each with its minutes on two cores after test.sh, without ccache.
stages="
house       5  what a reader of the sources has to know, counted; FEMWARP's depth (house.py)
freeze      3  results beside stored ones
long       11  fuzz, soak, installation, models, pages' examples, demo, core tests with other seeds
mpi         8  meshes on one to four MPI ranks
solvers     4  files that OpenFOAM, CalculiX and Gmsh read and solve
package    12  the Debian packages: made, checked (lintian), installed, tried and removed
site        3  the pages as a site: links, pictures, search, in a browser
portable   60  the core compiled for other systems, and its tests run there (portable.sh)
debian13   25  test.sh in Debian 13
sanitizers 20  core, fuzz, filters and two MPI ranks with address and undefined-behavior sanitizers
plainvtk   16  the library and its Python module with Debian's VTK
"

usage() {
  cat <<END
Usage: test-stages.sh [--minutes N] [--no-install] [-j N] [STAGE...]
Runs the stages that test.sh leaves out (all, or those that are named); test.sh comes first.
Stages and their minutes:
$stages
  --minutes N   leave out stages that would not end in N minutes, and stop one that does not
  --no-install  leave the packages alone
  -j N          processes (default: all cores)
What was left out is named. The exit status is 0 if all else has passed.
END
}

minutes=none
install=yes
jobs=$(nproc)
inside=no
chosen=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --minutes) shift; minutes=${1:?"--minutes needs a number"} ;;
    --no-install) install=no ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    --inside) inside=yes ;; # one stage, as a process that `timeout` can stop
    -*) usage >&2; exit 2 ;;
    *) chosen+=("$1") ;;
  esac
  shift
done

tests() { Utilities/ctest-log.sh "$@" -LE '^(slow|benchmark)$' -j "$jobs"; }
more_tests() { # builds those that test.sh leaves out
  cmake --preset paraview -DMESHMORPHING_TEST_GROUPS="benchmarks;fuzz;ranks;soak"
  cmake --build --preset paraview -j "$jobs"
}
on_debian_12() { # 77: left out
  if [ "$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}")" != "debian 12" ]; then exit 77; fi
}

if [ "$inside" = yes ]; then
  case "${chosen[0]}" in
    house) python3 Utilities/house.py --frames ;;
    freeze) tests build/paraview -L '^freeze$' ;;
    long)
      more_tests
      tests build/paraview -L '^(fuzz|install|long)$'
      for seed in 1 2 3; do MORPH_TEST_SEED=$seed tests build/paraview -R '^core\.Cases'; done ;;
    mpi) more_tests; tests build/paraview -L '^mpi$' ;;
    solvers) tests build/paraview -L '^solvers$' ;;
    package)
      made=$(Utilities/package.sh -j "$jobs")
      mapfile -t packages <<< "$made"
      lintian --fail-on error,warning build/debian/*.changes
      Testing/Install/package.sh "${packages[@]}" ;;
    site)
      on_debian_12
      /usr/bin/python3 Testing/site_browser.py # Debian's, which has Selenium
      Utilities/site.sh ;;
    portable) on_debian_12; Utilities/portable.sh -j "$jobs" ;;
    debian13) on_debian_12; Utilities/other-debian.sh trixie test -j "$jobs" ;;
    sanitizers)
      cmake --preset asan -DMESHMORPHING_UNITY_BUILD=ON \
        -DMESHMORPHING_TEST_GROUPS="fuzz;ranks;soak"
      cmake --build --preset asan -j "$jobs"
      tests build/asan -L '^(core|fuzz|filters)$'
      tests build/asan -R '^mpi\.Distributed2$' ;;
    plainvtk) on_debian_12; Utilities/plain-vtk.sh -j "$jobs" ;;
    *) usage >&2; exit 2 ;;
  esac
  exit
fi

if [ ${#chosen[@]} -eq 0 ]; then
  mapfile -t chosen < <(awk 'NF { print $1 }' <<< "$stages")
fi
if [ "$install" = yes ]; then
  Utilities/install-packages.sh --solvers --site --portable --package --other-debian
fi
if command -v ccache > /dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD
fi
status=0
said=()
for stage in "${chosen[@]}"; do
  needs=$(awk -v stage="$stage" '$1 == stage { print $2 }' <<< "$stages")
  if [ -z "$needs" ]; then echo "test-stages.sh: there is no stage $stage." >&2; exit 2; fi
  result=0
  begun=$SECONDS
  if [ "$minutes" = none ]; then
    "$0" --inside -j "$jobs" "$stage" || result=$?
  elif [ $((SECONDS + needs * 60)) -gt $((minutes * 60)) ]; then
    said+=("$stage: LEFT OUT, $needs minutes do not fit")
    continue
  else
    timeout $((minutes * 60 - SECONDS)) "$0" --inside -j "$jobs" "$stage" || result=$?
  fi
  took="$(((SECONDS - begun + 30) / 60)) minutes"
  case "$result" in
    0) said+=("$stage: passed, $took") ;;
    77) said+=("$stage: LEFT OUT, it cannot run here") ;;
    124) said+=("$stage: LEFT OUT, stopped after $took") ;;
    *) said+=("$stage: FAILED, $took"); status=1 ;;
  esac
done
printf '\n'
printf '%s\n' "${said[@]}"
exit $status
