#!/bin/sh
# effectivity.sh FOLDER-OF-THE-TOOLS - the tables of docs/methods/estimates.md.
set -eu
here=$(dirname "$0")
/usr/bin/python3 -s "$here/effectivity.py" "$1"
/usr/bin/python3 -s "$here/effectivity_damping.py" "$1"
/usr/bin/python3 -s "$here/effectivity_tail.py" "$1"
