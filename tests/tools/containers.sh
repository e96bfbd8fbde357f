#!/bin/sh
# containers.sh FOLDER-OF-THE-TOOLS - what containers hold: the tables of
# docs/container.md, and the members of a file, are the rows that read them.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

ritz-info --list | grep '^|' >rows
awk '/^\| member \| type \| shape \|/ { table = 1 } !/^\|/ { table = 0 } table' \
    "$here/../../docs/container.md" >page
works 'docs/container.md has the tables of ritz-info --list' diff page rows
expect 0 '| `columns/dof` | i64 | (r) |' ritz-info --list

import_chain --input tip=10:1 -o chain.h5
expect 0 'inputs/B                       f64              10, 1' \
    ritz-info --members chain.h5
json 0 ritz-info --members chain.h5
holds '  lists each with its form and sizes' \
    '{"member": "dofs/grid", "type": "i64", "shape": "10"} in j["members"] and
     not any(m["member"].startswith("grids") for m in j["members"])'
json 0 ritz-info chain.h5
holds '  and none unless asked' '"members" not in j'

echo "1..$count"
