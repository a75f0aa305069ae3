#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<END
Usage: release.sh [--only-here]
Makes a release of the last commit in build/release: the archive of its sources, and from what is in
this archive the Debian packages for this Debian, and for 13 if this is 12, Python's wheel, and
SHA256SUMS of all. The demo has to run from the archive. test.sh --all comes first.
  --only-here   no packages for another Debian than this
END
}

others=(trixie)
for option in "$@"; do
  case "$option" in
    -h | --help) usage; exit 0 ;;
    --only-here) others=() ;;
    *) usage >&2; exit 2 ;;
  esac
done
if [ -n "$(git status --porcelain)" ]; then
  echo "release.sh: commit or remove these first, since only what is committed is released:" >&2
  git status --short >&2
  exit 1
fi
if [ "$(. /etc/os-release && echo "${ID:-} ${VERSION_ID:-}")" != "debian 12" ]; then others=(); fi

name=meshmorphing-$(sed -n 's/^project(MeshMorphing VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
release=$PWD/build/release
rm -rf "$release"
mkdir -p "$release/work"
git archive --prefix="$name/" --output="$release/$name.tar.gz" HEAD
tar --extract --file "$release/$name.tar.gz" --directory "$release/work"
(
  cd "$release/work/$name"
  Utilities/install-packages.sh --package
  Utilities/demo.sh --no-install --output "$release/work/demo"
  # With the core that the demo has compiled.
  # Without pip's cache, where a wheel of another try would count as this version's.
  MESHMORPHING_BUILD=$PWD/build/paraview /usr/bin/python3 -m pip wheel --no-cache-dir \
    --no-build-isolation --no-deps --wheel-dir "$release" .
  Utilities/package.sh
  cp build/debian/*.deb "$release"
)
for suite in ${others[@]+"${others[@]}"}; do
  Utilities/other-debian.sh "$suite" package
  cp "build/$suite"/MeshMorphing/build/debian/*.deb "$release"
done
rm -rf "$release/work"
cd "$release"
sha256sum -- * > SHA256SUMS
echo "The release: $release"
cat SHA256SUMS
