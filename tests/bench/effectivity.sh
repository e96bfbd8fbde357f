#!/bin/sh
# effectivity.sh FOLDER-OF-THE-TOOLS - the tables of docs/methods/estimates.md.
set -eu
exec /usr/bin/python3 "$(dirname "$0")/effectivity.py" "$1"
