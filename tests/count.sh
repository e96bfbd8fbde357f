#!/bin/sh
# count.sh LOG - how many tests a ctest log holds, of cmocka and of TAP
# scripts, as "N passed, N failed, N skipped"; why some were skipped is said
# on standard error.
set -eu
awk '
/^\[  PASSED  \]/ { passed += $4 }
/^\[  FAILED  \] [0-9]+ test/ { failed += $4 }
/^\[  SKIPPED \] [0-9]+ test/ { skipped += $4; passed -= 0 }
/^ok [0-9]+/ { if (/# (skip|SKIP)/) skipped++; else passed++ }
/^not ok [0-9]+/ { failed++ }
/^skipped:/ { print > "/dev/stderr"; why++ }
END { printf "%d passed, %d failed, %d skipped\n", passed, failed, skipped }
' "$1"
