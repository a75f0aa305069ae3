#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: test.sh [--no-install] [--no-asan] [--asan-filters] [--no-plain-vtk] [--no-package] [-j N]
From a bare Debian 12 to tested builds: installs the packages, then
- builds the plugin (preset paraview) and runs the tests labelled core, filters, programs, install and paraview;
- builds with sanitizers (preset asan) and runs core, with --asan-filters filters too (10 minutes more on two cores);
- unpacks Debian's VTK 9.1, builds the library and the Python module with it (preset vtk91), and runs core, filters,
  programs and install;
- makes the Debian package, and installs, tries and removes it in a private view of the machine.
The summaries come last. The exit status is 0 if every test passed.
  --no-install    leave the packages alone
  --no-asan       leave the sanitizers out
  --asan-filters  the filters with sanitizers too
  --no-plain-vtk  leave VTK 9.1 out
  --no-package    leave the Debian package out
  -j N            processes to build and to test with (default: all cores)
END
}

install=yes
package=yes
asan_filters=no
presets=(paraview asan vtk91)
jobs=$(nproc)
leave_out() { for i in "${!presets[@]}"; do if [ "${presets[$i]}" = "$1" ]; then unset "presets[$i]"; fi; done; }
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --no-install) install=no ;;
    --no-asan) leave_out asan ;;
    --asan-filters) asan_filters=yes ;;
    --no-plain-vtk) leave_out vtk91 ;;
    --no-package) package=no ;;
    -j) shift; jobs=${1:?"-j needs a number"} ;;
    *) usage >&2; exit 2 ;;
  esac
  shift
done

if [ "$install" = yes ]; then Utilities/install-packages.sh; fi
if command -v ccache > /dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi

status=0
for preset in "${presets[@]}"; do
  if [ "$preset" = vtk91 ]; then Utilities/plain-vtk.sh --unpack-only; fi
  what=()
  which=()
  if [ "$preset" = asan ] && [ "$asan_filters" = no ]; then
    what=(--target MeshMorphingCoreTests)
    which=(-L core)
  fi
  cmake --preset "$preset"
  cmake --build --preset "$preset" -j "$jobs" "${what[@]}"
  ctest --preset "$preset" -j "$jobs" "${which[@]}" 2>&1 | tee "build/$preset/ctest.log" || status=1
done
package_summary="left out"
if [ "$package" = yes ]; then
  mkdir -p build
  package_status=0
  { Utilities/package.sh -j "$jobs" && Testing/Install/package.sh build/deb/*.deb; } 2>&1 |
    tee build/package.log || package_status=${PIPESTATUS[0]}
  package_summary=$(tail -n 1 build/package.log)
  # 77: no right to try it.
  if [ "$package_status" -ne 0 ] && [ "$package_status" -ne 77 ]; then status=1; fi
fi
for preset in "${presets[@]}"; do
  echo
  echo "== preset $preset"
  sed -n '/ tests passed/,$p' "build/$preset/ctest.log"
done
echo
echo "== Debian package"
echo "$package_summary"
exit $status
