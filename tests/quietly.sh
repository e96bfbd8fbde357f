#!/bin/sh
# quietly.sh STAMP COMMAND... - makes the stamp if the command succeeds, and
# prints what it says only if it does not.
stamp=$1
shift
mkdir -p "$(dirname "$stamp")"
if said=$("$@" 2>&1); then
    : >"$stamp"
else
    printf '%s\n' "$said" | grep -v 'warnings\{0,1\} generated'
    exit 1
fi
