#!/bin/sh
# caged.sh FOLDER-OF-THE-TOOLS - the table of caged joints in
# docs/methods/compare.md.
set -eu
exec /usr/bin/python3 -s "$(dirname "$0")/caged.py" "$1"
