#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

usage() {
  cat <<END
Usage: study.sh [--no-install] [--quick] [--output DIR] [option of study.py ...]
From a bare Debian 12 to the tables and plots of the paper's experiment: installs the packages,
builds the plugin under build/paraview and runs study.py, which takes many hours on two cores. An
interrupted run resumes where it was.
  --no-install   leave the packages alone
  --quick        a small mesh and few steps, in a minute
  --output DIR   where to write (default: study-output)
See pvpython Utilities/study.py --help for the rest.
END
}

install=yes
options=()
for option in "$@"; do
  case "$option" in
    -h | --help) usage; exit 0 ;;
    --no-install) install=no ;;
    *) options+=("$option") ;;
  esac
done

if [ "$install" = yes ]; then "$here/install-packages.sh"; fi
(
  cd "$here/.."
  cmake --preset paraview
  cmake --build --preset paraview --target MeshMorphing
)
# Debian's ParaView opens a display although nothing is drawn on it.
exec xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \
  /usr/bin/pvpython --force-offscreen-rendering "$here/study.py" ${options[@]+"${options[@]}"}
