#!/bin/sh
# house.sh [FOLDER] - the rules of the house that a script can hold: room
# order, no circle of files, table files, tolerances at home, no type twice.
exec /usr/bin/python3 -s -B "$(dirname "$0")/house.py" "${1:-$(dirname "$0")/..}"
