#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Lays out every C++ source by .clang-format (clang-format 14, Debian 12's). With --check it changes nothing and fails
# where a source would change.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=(-i)
case "${1:-}" in
  "") ;;
  --check) mode=(--dry-run -Werror) ;;
  *) echo "Usage: format.sh [--check]" >&2; exit 2 ;;
esac
find Examples Filters Plugin Programs Testing \( -name '*.h' -o -name '*.cxx' \) -print0 |
  xargs -0 clang-format --style=file "${mode[@]}"
