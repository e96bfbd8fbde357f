#!/bin/sh
# pages.sh FOLDER-OF-THE-TOOLS - run the commands and scripts of docs/import.md
# and docs/container.md that convert or write files.
exec /usr/bin/python3 -s "$(dirname "$0")/pages.py" "$1"
