# SPDX-License-Identifier: BSD-3-Clause
# Sourced, after usage() is there, by scripts that go from a bare Debian to a result:
#   run_built PACKAGES SCRIPT [--no-install] [option of SCRIPT ...]
# installs the packages (PACKAGES: an option of install-packages.sh, or empty), builds the plugin
# under build/paraview and runs SCRIPT by pvpython.

run_built() {
  local packages=$1 script=$2 install=yes option
  local options=()
  shift 2
  for option in "$@"; do
    case "$option" in
      -h | --help) usage; exit 0 ;;
      --no-install) install=no ;;
      *) options+=("$option") ;;
    esac
  done
  if [ "$install" = yes ]; then
    "$(dirname "$script")/install-packages.sh" ${packages:+"$packages"}
  fi
  "$(dirname "$script")/build.sh" MeshMorphing
  # Debian's ParaView opens a display even where nothing is drawn, and draws through X, offscreen
  # too. -noreset: an X server that resets itself when ParaView closes its first, trial connection
  # can miss the next one.
  exec xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \
    /usr/bin/pvpython --force-offscreen-rendering "$script" ${options[@]+"${options[@]}"}
}
