#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

usage() {
  cat <<END
Usage: study.sh [--no-install] [--quick] [--output DIR] [option of study.py ...]
From a bare Debian 12 or 13 to the tables and plots of the experiment: installs the packages,
builds the plugin under build/paraview and runs study.py, which takes many hours on two cores. An
interrupted run resumes where it was.
  --no-install   leave the packages alone
  --quick        a small mesh and few steps, in a minute
  --output DIR   where to write (default: study-output)
See pvpython Utilities/study.py --help for the rest.
END
}

. "$here/run-built.sh"
run_built "" "$here/study.py" "$@"
