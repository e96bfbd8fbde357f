#!/bin/sh
# ratios.sh FOLDER-OF-THE-TOOLS - print the table of docs/methods/damping.md.
set -eu
exec /usr/bin/python3 -s "$(dirname "$0")/ratios.py" "$1"
