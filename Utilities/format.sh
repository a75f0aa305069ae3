#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Lays out every C++ source by .clang-format (clang-format 14, Debian 12's). With --check it changes nothing and fails
# where a source would change, or has a line longer than 100 columns, which clang-format leaves in comments.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=(-i)
case "${1:-}" in
  "") ;;
  --check) mode=(--dry-run -Werror) ;;
  *) echo "Usage: format.sh [--check]" >&2; exit 2 ;;
esac
sources() {
  find Examples Filters Plugin Programs Testing \( -name '*.h' -o -name '*.cxx' \) -print0
}
sources | xargs -0 clang-format --style=file "${mode[@]}"
if [ "${1:-}" = --check ] && sources | LC_ALL=C.UTF-8 xargs -0 grep -nE '.{101}'; then
  echo "format.sh: these lines are longer than 100 columns." >&2
  exit 1
fi
