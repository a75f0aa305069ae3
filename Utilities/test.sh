#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

# The minutes that each stage should take on two cores, without ccache; the end compares with them.
debian_budget=35
sanitizer_budget=12
debian13_budget=18
mpi_budget=4
solvers_budget=4
site_budget=2

# What may be left out takes these minutes where the first build takes 24, and more where that takes
# longer.
first_build=24
debian13_minutes=30
package_minutes=2
site_minutes=2
sanitizer_minutes=20
plain_vtk_minutes=16

usage() {
  cat <<END
Usage: test.sh [--no-install] [--no-asan] [--asan-filters] [--no-plain-vtk] [--no-package]
               [--no-debian13] [--no-site] [--limit MINUTES] [--labels REGEX] [-j N]
From a bare Debian 12 or 13 to tested builds: installs the packages, then
- builds the plugin (preset paraview) and runs the tests labelled core, filters, fuzz, programs,
  install and paraview;
- on Debian 12 does the same in Debian 13, in a root file system of its own (see other-debian.sh),
  without the labels fuzz and programs. Where none can be made, the summary says so;
- makes the Debian package, and installs, tries and removes it in a private view of the machine;
- on Debian 12 builds the site (site.sh), and checks its links and pictures;
- builds with sanitizers (preset asan) and runs core, fuzz and the library of MPI ranks on two of
  them, and filters where half of the budget of $sanitizer_budget minutes is left;
- on Debian 12 unpacks its VTK 9.1, builds the library and the Python module with it (preset
  plain-vtk), and runs filters, fuzz, programs, install and mpi. The core knows no VTK. This build
  has MESHMORPHING_USE_MPI=OFF: its test of mpi expects the error of a mesh on several ranks.
The summaries and the minutes of each stage come last. The exit status is 0 if every test passed; a
stage that takes longer than its budget is named, but is no failure.
  --no-install    leave the packages alone
  --no-asan       leave the sanitizers out
  --asan-filters  the filters with sanitizers however long that takes
  --no-plain-vtk  leave VTK 9.1 out
  --no-package    leave the Debian package out
  --no-debian13   leave Debian 13 out
  --no-site       leave the site out
  --limit MINUTES leave out, or stop, what is not through after so many minutes; the summary names
                  it. The first build and its tests are never left out
  --labels REGEX  of the preset paraview run the tests with these labels alone
  -j N            processes to build and to test with (default: all cores)
END
}

install=yes
package=yes
asan_filters=no
asan=yes
plain_vtk=yes
debian13=yes
site=yes
limit=none
labels=()
jobs=$(nproc)
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --no-install) install=no ;;
    --no-asan) asan=no ;;
    --asan-filters) asan_filters=yes ;;
    --no-plain-vtk) plain_vtk=no ;;
    --no-package) package=no ;;
    --no-debian13) debian13=no ;;
    --no-site) site=no ;;
    --limit) shift; limit=${1:?"--limit needs minutes"} ;;
    --labels) shift; labels=(-L "${1:?"--labels needs a regular expression"}") ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if [ "$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}")" != "debian 12" ]; then
  plain_vtk=no
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

# Runs a command, and stops it where the limit is reached: then the exit status is 124.
limited() {
  if [ "$limit" = none ]; then "$@"; return; fi
  local left=$((limit * 60 - SECONDS))
  if [ "$left" -le 0 ]; then return 124; fi
  timeout "$left" "$@"
}
status=0
# Runs a function that may be left out: optional <its minutes> <name> <function>. The shell does not
# stop at an error in it. A machine that took longer for the first build takes longer for all.
built=0 # seconds of the first build
optional() {
  local budget=$1 name=$2 result=0
  local needed=$((budget * 60)) over
  if [ "$built" -gt $((first_build * 60)) ]; then
    needed=$((needed * built / (first_build * 60)))
  fi
  if [ "$limit" != none ] && [ $((SECONDS + needed)) -gt $((limit * 60)) ]; then
    over="$(minutes $SECONDS) of $limit minutes were over"
    left_out+=("$name: it takes some $(minutes "$needed") minutes here, and $over")
    return
  fi
  "$3" || result=$?
  case "$result" in
    0) ;;
    124) left_out+=("$name: stopped, $limit minutes were over") ;;
    *) status=1 ;;
  esac
}

configured=()
configure() {
  cmake --preset "$@" -DMESHMORPHING_PRECOMPILE_HEADERS="$precompile" &&
    rm -f "build/$1/ctest.log" && configured+=("$1")
}
build() { limited cmake --build --preset "$1" -j "$jobs" "${@:2}"; }
# The log of several runs of one preset is one: they are summed up together. Not by the preset,
# whose labels would win over these. A test that fails does not keep the next ones from running.
tests() {
  local result=0
  limited ctest --test-dir "build/$1" --output-on-failure -j "$jobs" "${@:2}" 2>&1 |
    tee -a "build/$1/ctest.log" || result=$?
  if [ "$result" -eq 124 ]; then return 124; fi
  if [ "$result" -ne 0 ]; then status=1; fi
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
  configure asan || return
  stage sanitizers "build asan (core, fuzz)" \
    build asan --target MeshMorphingCoreTests MeshMorphingFuzz || return
  stage sanitizers "tests asan (core)" tests asan -L core || return
  stage sanitizers "tests asan (fuzz)" tests asan -L fuzz || return
  if grep -q "^build MeshMorphingDistributedTests:" build/asan/build.ninja; then
    stage sanitizers "build asan (MPI ranks)" \
      build asan --target MeshMorphingDistributedTests || return
    stage sanitizers "tests asan (MPI ranks)" tests asan -R '^mpi\.Distributed2$' || return
  else
    left_out+=("MPI ranks with sanitizers: this build has no MPI or no hypre")
  fi
  if [ "$asan_filters" = no ] && [ "$(seconds_of sanitizers)" -gt $((sanitizer_budget * 30)) ]; then
    left_out+=("filters with sanitizers: less than half of the budget was left")
    return
  fi
  stage sanitizers "build asan (filters)" \
    build asan --target MeshMorphingFiltersTests MeshMorphingIOTests soak || return
  stage sanitizers "tests asan (filters)" tests asan -L filters
}

with_plain_vtk() {
  stage setup "VTK 9.1" Utilities/plain-vtk.sh --unpack-only || return
  configure plain-vtk -DMESHMORPHING_TEST_GROUPS="fuzz;soak" || return
  stage debian "build plain-vtk" build plain-vtk || return
  stage debian "tests plain-vtk" tests plain-vtk -LE 'slow|benchmark|core'
}

package_summary="left out"
make_package() {
  {
    limited Utilities/package.sh --from build/paraview -j "$jobs" &&
      limited Testing/Install/package.sh build/paraview/*.deb
  } 2>&1 | tee build/package.log
}
package() {
  local result=0
  stage debian "Debian package" make_package || result=$?
  package_summary=$(tail -n 1 build/package.log)
  if [ "$result" -eq 77 ]; then return; fi # no right to try it
  return $result
}

site_summary="left out"
make_site() { limited Utilities/site.sh 2>&1 | tee build/site.log; }
site() {
  local result=0
  stage site "site" make_site || result=$?
  site_summary=$(tail -n 2 build/site.log)
  return $result
}

# The packages of Debian 13 are fetched while this Debian's build runs. Whatever fails is tried
# again, and named, when its turn comes.
debian13_root=none # the process
prepare_debian13() {
  local most=3600
  if [ "$limit" != none ]; then most=$((limit * 60 - SECONDS)); fi
  timeout "$most" Utilities/other-debian.sh trixie root > build/trixie.log 2>&1 &
  debian13_root=$!
  trap drop_debian13_root EXIT
}
drop_debian13_root() {
  if [ "$debian13_root" != none ]; then kill "$debian13_root" 2> /dev/null || true; fi
  debian13_root=none
}
in_debian13() {
  local result=0
  if [ "$debian13_root" != none ]; then
    stage debian13 "root of Debian 13" wait "$debian13_root" || tail -n 3 build/trixie.log
    debian13_root=none
  fi
  stage debian13 "Debian 13" limited Utilities/other-debian.sh trixie test -j "$jobs" \
    --labels '^(core|filters|install|paraview)$' || result=$?
  if [ "$result" -eq 77 ]; then
    left_out+=("Debian 13: no root file system can be made, or the registry does not answer")
    return
  fi
  return $result
}

precompile=ON # headers, which ccache could not share, where it was not there before
if command -v ccache > /dev/null; then precompile=OFF; fi
if [ "$install" = yes ]; then
  packages=(Utilities/install-packages.sh)
  if [ "$site" = yes ]; then packages+=(--site); fi
  stage setup "packages" "${packages[@]}"
fi
if [ "$precompile" = OFF ]; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  # The presets share what they compile alike, such as the core, whatever their build folder is.
  export CCACHE_BASEDIR=$PWD
fi
mkdir -p build
first() { local limit=none && stage "$@"; } # a stage that is never stopped
if [ ${#labels[@]} -gt 0 ]; then
  groups="" # of test programs that these labels need
  for label in fuzz:fuzz mpi:ranks filters:soak; do
    if [[ ${label%:*} =~ ${labels[1]} ]]; then groups+="${label#*:};"; fi
  done
  configure paraview -DMESHMORPHING_TEST_GROUPS="$groups"
  first debian "build paraview" build paraview
  built=$(seconds_of debian)
  first debian "tests paraview" tests paraview "${labels[@]}" -LE 'slow|benchmark'
else
  configure paraview -DMESHMORPHING_TEST_GROUPS="benchmarks;fuzz;ranks;soak"
  if [ "$debian13" = yes ] && [ "$install" = yes ]; then prepare_debian13; fi
  first debian "build paraview" build paraview
  built=$(seconds_of debian)
  first debian "tests paraview" tests paraview -LE 'slow|benchmark|mpi|solvers'
  first mpi "tests paraview (mpi)" tests paraview -L mpi
  first solvers "tests paraview (solvers)" tests paraview -L solvers
fi
debian13_log=build/trixie/MeshMorphing/build/paraview/ctest.log
if [ "$debian13" = yes ]; then rm -f "$debian13_log"; fi # of another run
if [ "$debian13" = yes ]; then optional $debian13_minutes "Debian 13" in_debian13; fi
drop_debian13_root
if [ "$package" = yes ]; then optional $package_minutes "Debian package" package; fi
if [ "$site" = yes ]; then optional $site_minutes "site" site; fi
if [ "$asan" = yes ]; then optional $sanitizer_minutes "sanitizers" sanitized; fi
if [ "$plain_vtk" = yes ]; then optional $plain_vtk_minutes "VTK 9.1" with_plain_vtk; fi

if [ "$debian13" = yes ] && [ -e "$debian13_log" ]; then
  printf '\n== Debian 13, preset paraview\n'
  summary "$debian13_log"
fi
for preset in "${configured[@]}"; do
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
