#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

usage() {
  cat <<END
Usage: demo.sh [--no-install] [--output DIR] [--steps N] [--no-picture | --picture-each]
From a bare Debian 12 or 13 to a morphed mesh: installs the packages, builds the plugin under
build/paraview, morphs the bore with FEMWARP, prints quality before and after, and writes meshes,
series and a picture; then morphs it with each other method (see demo.py).
  --no-install   leave the packages alone
  --output DIR   where to write (default: demo-output)
  --steps N      steps from the initial to the final shape (default: 20)
  --no-picture   do not render
  --picture-each a picture for each method, not for FEMWARP alone
END
}

. "$here/run-built.sh"
run_built --demo "$here/demo.py" "$@"
