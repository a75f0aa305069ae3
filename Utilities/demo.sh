#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

usage() {
  cat <<END
Usage: demo.sh [--no-install] [--output DIR] [--steps N] [--no-picture | --picture-each]
From a bare Debian 12 or 13 to a morphed mesh: installs the packages, builds the plugin under
build/paraview, morphs the bore with each method, prints quality before and after, and writes
meshes, series and a picture (see demo.py).
  --no-install   leave the packages alone
  --output DIR   where to write (default: demo-output)
  --steps N      steps from the initial to the final shape (default: 20)
  --no-picture   do not render
  --picture-each a picture for each method, not for FEMWARP alone
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
# Debian's ParaView draws through X, offscreen too. -noreset: an X server that resets itself when
# ParaView closes its first, trial connection can miss the next one.
exec xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \
  /usr/bin/pvpython --force-offscreen-rendering "$here/demo.py" ${options[@]+"${options[@]}"}
