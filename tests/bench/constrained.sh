#!/bin/sh
# constrained.sh FOLDER-OF-THE-TOOLS [--chart FILE.svg] - the tables of
# docs/methods/constraints-in-time.md.
set -eu
exec /usr/bin/python3 -s "$(dirname "$0")/constrained.py" "$@"
