#!/bin/sh
# swept.sh FOLDER-OF-THE-TOOLS - errors and cost of runs in which a joint turns:
# the tables of docs/methods/swept.md.
set -eu
exec /usr/bin/python3 -s "$(dirname "$0")/swept.py" "$1"
