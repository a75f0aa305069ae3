#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/Utilities/export-sources.sh"

usage() {
  cat <<END
Usage: other-debian.sh SUITE [test|demo|package|shell] [OPTION...]
       other-debian.sh SUITE --clean
Tries MeshMorphing in another Debian (SUITE: trixie or sid), or in a bare one (bookworm, too),
without a machine of its own. Makes a root file system in build/SUITE with mmdebstrap, from the
registry that this machine uses, copies the project's sources into it, and runs there
  test    Utilities/test.sh (default)
  demo    Utilities/demo.sh
  package Utilities/package.sh; then the packages are installed, tried and removed
  shell   bash, in the copy of the project
with the options that follow. The root file system and its builds, some gigabytes, are kept for the
next run; --clean removes them. Needs root, or mmdebstrap's unshare mode.
Exits with 77 where the registry does not answer, or where no root file system can be made.
END
}

case "${1:-}" in
  -h | --help) usage; exit 0 ;;
  bookworm | trixie | sid) suite=$1; shift ;;
  *) usage >&2; exit 2 ;;
esac
root=$here/build/$suite
project=$root/MeshMorphing

as_root=()
if [ "$(id -u)" -ne 0 ]; then as_root=(unshare --user --map-root-user --map-auto); fi
if [ "${1:-}" = --clean ]; then
  "${as_root[@]}" rm -rf "$root" "$root.partial"
  exit 0
fi
command=${1:-test}
if [ $# -gt 0 ]; then shift; fi
case "$command" in test | demo | package | shell) ;; *) usage >&2; exit 2 ;; esac
unavailable() { echo "other-debian.sh: $suite is not available: $1" >&2; exit 77; }

# The registry of this machine's own Debian holds the other suites too.
registry() {
  # shellcheck disable=SC2016 # apt's own variables
  apt-get indextargets --format '$(REPO_URI) $(ORIGIN)' 'Created-By: Packages' |
    awk '$2 == "Debian" && $1 !~ /security/ { print $1; exit }'
}

make_root() {
  local mirror options=()
  if ! command -v mmdebstrap > /dev/null; then
    "$here/Utilities/install-packages.sh" --other-debian
  fi
  mirror=$(registry)
  if [ -z "$mirror" ]; then unavailable "apt has no registry of Debian here."; fi
  # The index of sid may be older than it promises, where a registry keeps a copy.
  if [ "$suite" = sid ]; then options+=(--aptopt='Acquire::Check-Valid-Until "false"'); fi
  # Under its name once it is whole.
  "${as_root[@]}" rm -rf "$root" "$root.partial"
  mkdir -p "$(dirname "$root")"
  # A root that a power cut spoils is made again: dpkg need not wait for the disk.
  mmdebstrap --variant=apt --include=ca-certificates --dpkgopt=force-unsafe-io \
    --aptopt='Acquire::Retries "3"' ${options[@]+"${options[@]}"} \
    "$suite" "$root.partial" "$mirror" || {
    "${as_root[@]}" rm -rf "$root.partial"
    unavailable "mmdebstrap could not make it from $mirror"
  }
  "${as_root[@]}" mv "$root.partial" "$root"
}

# Files that have changed get the time of the copy, so that they are built again even if they were
# edited while an earlier build ran; all others stay.
copy_sources() {
  local fresh=$root/MeshMorphing.new
  "${as_root[@]}" rm -rf "$fresh"
  "${as_root[@]}" mkdir -p "$fresh" "$project"
  (cd "$here" && export_sources) |
    "${as_root[@]}" tar --extract --directory "$fresh" --no-same-owner
  # shellcheck disable=SC2016 # expanded inside
  "${as_root[@]}" bash -euc '
    sums() { (cd "$1" && find . -path ./build -prune -o -type f -exec sha256sum {} + | sort); }
    names() { cut -c 67- | tr "\n" "\0"; } # after 64 digits and two blanks
    sums "$1" > "$1.sums"
    sums "$2" > "$2.sums"
    (cd "$2" && comm -13 "$1.sums" "$2.sums" | names | xargs -0 --no-run-if-empty rm)
    (cd "$1" && comm -23 "$1.sums" "$2.sums" | names | xargs -0 --no-run-if-empty touch)
    comm -23 "$1.sums" "$2.sums" | names |
      tar --create --directory "$1" --null --files-from=- | tar --extract --directory "$2"
    rm -rf "$1" "$1.sums" "$2.sums"
  ' bash "$fresh" "$project"
}

# A private view of the machine with the other root: what is mounted goes with the process. Its
# first process is a shell, since Xvfb never tells process 1 that it is ready, and xvfb-run waits.
inside() {
  # shellcheck disable=SC2016 # expanded inside
  "${as_root[@]}" unshare --mount --pid --fork --kill-child bash -euc '
    root=$1; shift
    mount --bind "$root" "$root" # a mount of its own, so that what runs there may unshare mounts
    mount --rbind /dev "$root/dev"
    mount -t proc proc "$root/proc"
    mount --rbind /sys "$root/sys"
    mount -t tmpfs tmpfs "$root/tmp"
    cp --dereference /etc/resolv.conf "$root/etc/resolv.conf"
    exec chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      TERM="${TERM:-dumb}" bash -c "cd /MeshMorphing && \"\$@\"; exit \$?" bash "$@"
  ' bash "$root" "$@"
}

# The same, for what installs packages first: a kept root, too, may lack one that is new. An
# installation that was interrupted is ended.
installing() {
  local result=0
  # shellcheck disable=SC2016 # expanded inside
  inside bash -c 'dpkg --configure -a && exec "$@"' bash "$@" || result=$?
  if [ "$result" -eq 77 ]; then unavailable "see above."; fi
  return "$result"
}

if [ ! -e "$root/etc/debian_version" ]; then make_root; fi
copy_sources
case "$command" in
  test) installing Utilities/test.sh "$@" ;;
  demo) installing Utilities/demo.sh "$@" ;;
  package)
    # shellcheck disable=SC2016 # expanded inside
    installing bash -euc '
      Utilities/install-packages.sh --package
      made=$(Utilities/package.sh "$@")
      mapfile -t packages <<< "$made"
      lintian --fail-on error,warning build/debian/*.changes
      result=0
      Testing/Install/package.sh "${packages[@]}" || result=$?
      if [ "$result" -eq 77 ]; then exit 1; fi # no right to try it, which is no silent registry
      exit "$result"
    ' bash "$@"
    ;;
  shell) if [ $# -gt 0 ]; then inside "$@"; else inside bash; fi ;;
esac
