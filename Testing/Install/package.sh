#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Tests the Debian packages: they install with their dependencies there, the plugin is listed and
# loaded by ParaView, the libraries serve the examples, and nothing is left behind when they are
# removed. All of it in a private view of /usr, /etc and /var: the machine stays as it is.
# Usage: package.sh <package.deb>...      (as root)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

if [ "${1:?"Usage: package.sh <package.deb>..."}" != inside ]; then
  if ! unshare --mount true 2> /dev/null; then
    echo "package.sh: needs the right to mount (root); the packages are not tested." >&2
    exit 77
  fi
  exec unshare --mount "$here/package.sh" inside "$@"
fi

shift
scratch=/mnt
mount -t tmpfs tmpfs "$scratch"
for folder in usr etc var; do
  mkdir -p "$scratch/$folder/upper" "$scratch/$folder/work"
  layers="lowerdir=/$folder,upperdir=$scratch/$folder/upper,workdir=$scratch/$folder/work"
  mount -t overlay overlay -o "$layers" "/$folder"
done
files() {
  find /usr /etc -not -name '*.pyc' -not -name __pycache__ -not -path '/usr/share/mime/*' | sort
}

files > "$scratch/before"
dpkg -i "$@"
env -u PV_PLUGIN_PATH pvpython "$here/installed_plugin.py"
morph-mesh --version
cmake -G Ninja -S "$here/../../Examples" -B "$scratch/examples" > "$scratch/log" ||
  { cat "$scratch/log"; exit 1; }
cmake --build "$scratch/examples"
model=$here/../../Data/Models/small/bore_hex_small.vtu
"$scratch/examples/twist-grid" "$model" 5 "$scratch/out.vtk"
"$scratch/examples/stretch-cube"
dpkg -L meshmorphing libmeshmorphing-dev | sed 's/^/    /'
dpkg -r meshmorphing libmeshmorphing-dev
files > "$scratch/after"
diff "$scratch/before" "$scratch/after"
echo "The packages install, work, and are removed without a trace."
