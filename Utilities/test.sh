#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

# Minutes on two cores, without ccache.
debian_budget=35
sanitizer_budget=12
debian13_budget=18
mpi_budget=4
solvers_budget=4
site_budget=2

usage() {
  cat <<END
Usage: test.sh [--no-install] [--no-asan] [--asan-filters] [--no-plain-vtk] [--no-package]
               [--no-debian13] [--no-site] [--labels REGEX] [-j N]
From a bare Debian 12 or 13 to tested builds: installs the packages, then
- builds the plugin (preset paraview) and runs the tests labelled core, filters, fuzz, programs,
  install and paraview;
- builds with sanitizers (preset asan) and runs core, fuzz and the library of MPI ranks on two of
  them, and filters where half of the budget of $sanitizer_budget minutes is left;
- on Debian 12 unpacks its VTK 9.1, builds the library and the Python module with it (preset
  plain-vtk), and runs core, filters, fuzz, programs and install;
- makes the Debian package, and installs, tries and removes it in a private view of the machine;
- on Debian 12 builds the site (site.sh), and checks its links and pictures;
- on Debian 12 does the first of these in Debian 13 as well, in a root file system of its own (see
  other-debian.sh), without the labels fuzz and programs. Where none can be made, the summary says
  so.
The summaries and the minutes of each stage come last. The exit status is 0 if every test passed; a
stage that takes longer than its budget is named, but is no failure.
  --no-install    leave the packages alone
  --no-asan       leave the sanitizers out
  --asan-filters  the filters with sanitizers however long that takes
  --no-plain-vtk  leave VTK 9.1 out
  --no-package    leave the Debian package out
  --no-debian13   leave Debian 13 out
  --no-site       leave the site out
  --labels REGEX  of the preset paraview run the tests with these labels alone
  -j N            processes to build and to test with (default: all cores)
END
}

install=yes
package=yes
asan_filters=no
presets=(paraview asan plain-vtk)
debian13=yes
site=yes
labels=()
jobs=$(nproc)
leave_out() {
  for i in "${!presets[@]}"; do
    if [ "${presets[$i]}" = "$1" ]; then unset "presets[$i]"; fi
  done
}
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --no-install) install=no ;;
    --no-asan) leave_out asan ;;
    --asan-filters) asan_filters=yes ;;
    --no-plain-vtk) leave_out plain-vtk ;;
    --no-package) package=no ;;
    --no-debian13) debian13=no ;;
    --no-site) site=no ;;
    --labels) shift; labels=(-L "${1:?"--labels needs a regular expression"}") ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if [ "$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}")" != "debian 12" ]; then
  leave_out plain-vtk
  debian13=no
  site=no
fi

stages=() # "seconds group name" of each
left_out=()
# Runs a command as a stage of a group: stage <group> <name> <command>...
stage() {
  local group=$1 name=$2 start=$SECONDS result=0
  shift 2
  "$@" || result=$?
  stages+=("$((SECONDS - start)) $group $name")
  return $result
}
seconds_of() {
  printf '%s\n' "${stages[@]}" |
    awk -v group="$1" '$2 == group { sum += $1 } END { print sum + 0 }'
}
minutes() { awk -v seconds="$1" 'BEGIN { printf "%.1f", seconds / 60 }'; }

status=0
build() { cmake --build --preset "$1" -j "$jobs" "${@:2}"; }
# The log of several runs of one preset is one: they are summed up together. Not by the preset,
# whose labels would win over these.
tests() {
  ctest --test-dir "build/$1" --output-on-failure -j "$jobs" "${@:2}" 2>&1 |
    tee -a "build/$1/ctest.log"
}

# CTest's summary, and the end of what the failed tests said.
summary() {
  if [ -e "$1" ]; then
    awk '/^Test project/ { on = 0 } / tests passed/ { on = 1 } on' "$1"
    awk '/^ *[0-9]+\/[0-9]+ Test +#|^ +Start +[0-9]+: |^[0-9]+% tests/ {
           on = /\*\*\*(Failed|Timeout|Exception)/
         } on' "$1" | tail -n 40
  else
    echo "not reached"
  fi
}

sanitized() {
  stage sanitizers "build asan (core, fuzz)" \
    build asan --target MeshMorphingCoreTests MeshMorphingFuzz
  stage sanitizers "tests asan (core)" tests asan -L core || status=1
  stage sanitizers "tests asan (fuzz)" tests asan -L fuzz || status=1
  if grep -q "^build MeshMorphingDistributedTests:" build/asan/build.ninja; then
    stage sanitizers "build asan (MPI ranks)" build asan --target MeshMorphingDistributedTests
    stage sanitizers "tests asan (MPI ranks)" tests asan -R '^mpi\.Distributed2$' || status=1
  else
    left_out+=("MPI ranks with sanitizers: this build has no MPI or no hypre")
  fi
  if [ "$asan_filters" = no ] && [ "$(seconds_of sanitizers)" -gt $((sanitizer_budget * 30)) ]; then
    left_out+=("filters with sanitizers: less than half of the budget was left")
    return
  fi
  stage sanitizers "build asan (filters)" \
    build asan --target MeshMorphingFiltersTests MeshMorphingIOTests soak
  stage sanitizers "tests asan (filters)" tests asan -L filters || status=1
}

make_package() {
  { Utilities/package.sh -j "$jobs" && Testing/Install/package.sh build/deb/*.deb; } 2>&1 |
    tee build/package.log
}

if [ "$install" = yes ]; then
  packages=(Utilities/install-packages.sh)
  if [ "$site" = yes ]; then packages+=(--site); fi
  stage setup "packages" "${packages[@]}"
fi
if command -v ccache > /dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  # The presets share what they compile alike, such as the core, whatever their build folder is.
  export CCACHE_BASEDIR=$PWD
fi
for preset in "${presets[@]}"; do
  if [ "$preset" = plain-vtk ]; then stage setup "VTK 9.1" Utilities/plain-vtk.sh --unpack-only; fi
  cmake --preset "$preset"
  rm -f "build/$preset/ctest.log"
  if [ "$preset" = asan ]; then
    sanitized
  else
    stage debian "build $preset" build "$preset"
    if [ "$preset" = paraview ] && [ ${#labels[@]} -gt 0 ]; then
      stage debian "tests $preset" tests "$preset" "${labels[@]}" -LE 'slow|benchmark' || status=1
    else
      stage debian "tests $preset" tests "$preset" -LE 'slow|benchmark|mpi|solvers' || status=1
      stage mpi "tests $preset (mpi)" tests "$preset" -L mpi || status=1
      stage solvers "tests $preset (solvers)" tests "$preset" -L solvers || status=1
    fi
  fi
done
package_summary="left out"
if [ "$package" = yes ]; then
  mkdir -p build
  package_status=0
  stage debian "Debian package" make_package || package_status=$?
  package_summary=$(tail -n 1 build/package.log)
  # 77: no right to try it.
  if [ "$package_status" -ne 0 ] && [ "$package_status" -ne 77 ]; then status=1; fi
fi

site_summary="left out"
if [ "$site" = yes ]; then
  mkdir -p build
  make_site() { Utilities/site.sh 2>&1 | tee build/site.log; }
  stage site "site" make_site || status=1
  site_summary=$(tail -n 2 build/site.log)
fi

if [ "$debian13" = yes ]; then
  debian13_status=0
  stage debian13 "Debian 13" Utilities/other-debian.sh trixie test -j "$jobs" \
    --labels '^(core|filters|install|paraview)$' || debian13_status=$?
  if [ "$debian13_status" -eq 77 ]; then
    left_out+=("Debian 13: no root file system can be made, or the registry does not answer")
    debian13=no
  elif [ "$debian13_status" -ne 0 ]; then
    status=1
  fi
fi

if [ "$debian13" = yes ]; then
  printf '\n== Debian 13, preset paraview\n'
  summary build/trixie/MeshMorphing/build/paraview/ctest.log
fi
for preset in "${presets[@]}"; do
  printf '\n== preset %s\n' "$preset"
  summary "build/$preset/ctest.log"
done
printf '\n== Debian package\n%s\n\n== Site\n%s\n\n== Minutes\n' "$package_summary" "$site_summary"
for one in "${stages[@]}"; do
  read -r seconds group name <<< "$one"
  printf '%-26s%6s\n' "$name" "$(minutes "$seconds")"
done
for group in "debian $debian_budget" "sanitizers $sanitizer_budget" "debian13 $debian13_budget" \
  "mpi $mpi_budget" "solvers $solvers_budget" "site $site_budget"; do
  read -r group budget <<< "$group"
  taken=$(seconds_of "$group")
  if [ "$taken" -eq 0 ]; then continue; fi
  over="within its budget"
  if [ "$taken" -gt $((budget * 60)) ]; then over="EXCEEDED its budget"; fi
  printf '%-26s%6s  %s of %s minutes\n' "all of $group" "$(minutes "$taken")" "$over" "$budget"
done
if [ ${#left_out[@]} -gt 0 ]; then printf 'Left out: %s\n' "${left_out[@]}"; fi
exit $status
