#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Lays out every C++ source by .clang-format (clang-format 14, Debian 12's). With --check it changes
# nothing, and fails where a source would change. It fails too where a line is longer than 100
# columns: clang-format leaves such lines in comments, and Python, shell and CMake have no
# formatter.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=(-i)
case "${1:-}" in
  "") ;;
  --check) mode=(--dry-run -Werror) ;;
  *) echo "Usage: format.sh [--check]" >&2; exit 2 ;;
esac
sources() {
  find Examples Filters Plugin Programs Python Testing \( -name '*.h' -o -name '*.cxx' \) -print0
}
# States that ParaView wrote are as it wrote them.
scripts() {
  find . \( -path ./build -o -path './Testing/ParaView/states-*' -o -name '.?*' \) -prune -o \
    \( -name '*.py' -o -name '*.py.in' -o -name '*.sh' -o -name '*.cmake' -o -name '*.cmake.in' \
    -o -name CMakeLists.txt \) -print0
}
sources | xargs -0 clang-format --style=file "${mode[@]}"
if [ "${1:-}" = --check ]; then
  long=$({ sources; scripts; } | LC_ALL=C.UTF-8 xargs -0 grep -nE '.{101}' || true)
  if [ -n "$long" ]; then
    printf '%s\n' "$long"
    echo "format.sh: these lines are longer than 100 columns." >&2
    exit 1
  fi
fi
