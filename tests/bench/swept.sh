#!/bin/sh
# swept.sh FOLDER-OF-THE-TOOLS - the table of a joint that turns in
# docs/methods/swept.md.
set -eu
exec /usr/bin/python3 -s "$(dirname "$0")/swept.py" "$1"
