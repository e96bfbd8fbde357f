#!/bin/sh
# methods.sh FOLDER-OF-THE-TOOLS - the tables of docs/methods/errors.md, without
# the block of bricks, which methods.py adds with --solid 25.
set -eu
exec /usr/bin/python3 -s "$(dirname "$0")/methods.py" "$1"
