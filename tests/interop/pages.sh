#!/bin/sh
# pages.sh FOLDER-OF-THE-TOOLS - what docs/import.md and docs/container.md say
# of files that scripts write or convert is done, as it stands there.
exec /usr/bin/python3 -s "$(dirname "$0")/pages.py" "$1"
