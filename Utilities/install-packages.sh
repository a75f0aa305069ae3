#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail

usage() {
  cat <<END
Usage: install-packages.sh [--use | --demo] [--numpy] [--solvers] [--benchmark] [--developer]
                           [--site] [--portable] [--package] [--other-debian] [--list]
Installs the Debian packages that MeshMorphing is built and tested with, as root or through sudo.
Does nothing where they are all installed. Exits with 77 where the registry does not answer.
  --use         only what it takes to build and to use it: compiler, ParaView, libraries
  --demo        that, and what demo.sh needs (Gmsh, Xvfb)
  --numpy       also what Python's package for NumPy is built and used with (pybind11, pip, meshio)
  --solvers     also OpenFOAM and CalculiX (400 MB), which read and solve what morph-mesh writes
  --benchmark   also what benchmarks need: solvers to compare with (PETSc), and xdotool
  --developer   also ccache, and what format.sh, lint.sh, check-documentation.sh and
                design_picture.py need (clang, clang-format, clang-tidy, doxygen, graphviz)
  --site        also what site.sh and its test need (mkdocs, doxygen, chromium)
  --portable    also compilers for other systems, see portable.sh
  --package     also what package.sh and its test need (build-essential, debhelper, lintian)
  --other-debian  also what other-debian.sh needs (mmdebstrap)
  --list        only names the packages
Knows Debian 12, 13 and unstable.
END
}

demo=(gmsh python3-gmsh xvfb xauth)
tests=(git dpkg-dev file gdb cgns-convert netcdf-bin libgtest-dev python3-matplotlib
  imagemagick libxtst6)
numpy=(pybind11-dev python3-dev python3-pip python3-setuptools python3-wheel python3-venv
  python3-meshio python3-scipy)
solvers=(openfoam calculix-ccx)
release=$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-${VERSION_CODENAME:-}}")
# What it takes to build stands in debian/control, which names Qt 6 before Qt 5.
mapfile -t packages < <(awk -v without="$([ "$release" = "debian 12" ] && echo "^qt6")" '
  /^Build-Depends:/ { inside = 1; next }
  inside && !/^ / { exit }
  inside {
    gsub(/\([^)]*\)|[ ,]/, "")
    split($0, names, "|")
    print names[without != "" && names[1] ~ without ? 2 : 1]
  }' "$(dirname "$0")/../debian/control" | sort --unique)
packages+=(g++)
case "$release" in
  "debian 12") ;;
  "debian 13")
    solvers=() # It has no CalculiX.
    packages+=(qt6-svg-plugins) # the icons of ParaView, which does not ask for it
    tests+=(mount) ;;
  *) # Of Debian's unstable suite: paraview-dev stands on the system's VTK; xmlpatterns is gone.
    solvers=(calculix-ccx)
    packages=("${packages[@]/qtxmlpatterns5-dev-tools/xsltproc}" libvtk9-dev libvtk9-qt-dev
      qt6-svg-plugins)
    tests+=(mount)
    if [ "${release% *}" != debian ] || [ -n "${release//[!0-9]/}" ]; then
      echo "install-packages.sh: written for Debian, this is '$release'. Going on; package names" \
        "may differ." >&2
    fi ;;
esac

basis=("${demo[@]}" "${numpy[@]}" "${tests[@]}")
list=
for option in "$@"; do
  case "$option" in
    -h | --help) usage; exit 0 ;;
    --use) basis=() ;;
    --demo) basis=("${demo[@]}") ;;
    --numpy) packages+=("${numpy[@]}") ;;
    --solvers) packages+=(${solvers[@]+"${solvers[@]}"}) ;;
    --benchmark) packages+=(python3-petsc4py xdotool) ;;
    --developer) packages+=(ccache clang clang-format clang-tidy doxygen graphviz) ;;
    --site) packages+=(mkdocs doxygen chromium chromium-driver python3-selenium) ;;
    --portable) packages+=(clang googletest g++-mingw-w64-x86-64-posix wine64 g++-aarch64-linux-gnu
      qemu-user emscripten) ;;
    --package) packages+=(build-essential debhelper lintian) ;;
    --other-debian) packages+=(mmdebstrap uidmap) ;;
    --list) list=yes ;;
    *) usage >&2; exit 2 ;;
  esac
done
packages+=(${basis[@]+"${basis[@]}"})
if [ -n "$list" ]; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

if ! command -v apt-get > /dev/null; then
  echo "install-packages.sh: no apt-get here. Install what these Debian packages hold:" \
    "${packages[*]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null || true)
  if [ "$status" != installed ]; then missing+=("$package"); fi
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "All ${#packages[@]} packages are installed."
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "install-packages.sh: run this as root, there is no sudo. Missing: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
apt() {
  ${as_root[@]+"${as_root[@]}"} env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get \
    -o Acquire::Retries=3 "$@"
}
no_answer() { echo "install-packages.sh: the registry does not answer: see above." >&2; exit 77; }
# Another registry than Debian's may fail: then all goes well all the same.
updated=yes
apt update --error-on=any || updated=no
if ! apt install --simulate --no-install-recommends "${missing[@]}" > /dev/null; then
  if [ "$updated" = no ] && ! compgen -G "/var/lib/apt/lists/*Packages*" > /dev/null; then
    no_answer
  fi
  exit 1
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! apt install -y --download-only --no-install-recommends "${missing[@]}" 2>&1 | tee "$log"; then
  if grep -qE '(Failed|Unable) to fetch' "$log"; then no_answer; fi
  exit 1
fi
apt install -y --no-install-recommends "${missing[@]}"
