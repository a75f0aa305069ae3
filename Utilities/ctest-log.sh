#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
set -euo pipefail
if [ $# -eq 0 ] || [ "$1" = -h ] || [ "$1" = --help ]; then
  echo "Usage: ctest-log.sh BUILD [OPTION of ctest...]"
  echo "Runs CTest there, keeps what it says in a log beside the other runs' (BUILD/ctest-*.log),"
  echo "and names the cases that failed inside of a test. The exit status is CTest's."
  exit 2
fi
build=$1
shift
log=$(mktemp "$build/ctest-XXXXXX.log")
status=0
ctest --test-dir "$build" --output-on-failure "$@" 2>&1 | tee "$log" || status=$?
# GoogleTest's cases; of a program that crashed the last one that began. unittest's cases.
awk '/^\[ +RUN +\] / { running = $4 }
     /^\[ +(OK|FAILED) +\] / { running = "" }
     /^\[  FAILED  \] [A-Za-z_0-9\/]+\.[A-Za-z_0-9\/]+/ { sub(/,$/, "", $4); failed[$4] = 1 }
     /^(FAIL|ERROR): test_/ { failed[$2 " " $3] = 1 }
     /\*\*\*(Exception|Timeout)/ { if (running != "") failed[running] = 1; running = "" }
     END { for (name in failed) print "Failed: " name }' "$log" | sort
exit "$status"
