#!/bin/sh
# rigid.sh FOLDER-OF-THE-TOOLS - a body that the simulator moves rigidly feels no
# elastic force, in every format with frames: a block of solid whose matrices
# have all digits, with axes of its own at every third grid and a hub at each end.
. "$(dirname "$0")/tap.sh"

# rigid ARGUMENT...: rigid.py, which reads files by their published layouts.
rigid() { /usr/bin/python3 -s "$here/rigid.py" "$@"; }

expect 0 '' rigid write "$bin"
expect 0 'rows' ritz-import --stiffness K.mtx --mass M.mtx --bulk block.bdf \
    --dofs block.dofs --rigid-port root=1-9 --rigid-port tip=37-45 \
    --units 'kg m s' -o block.h5
ritz-basis -q craig-bampton --attach root,tip --modes 6 block.h5 -o basis.h5
ritz-reduce -q block.h5 basis.h5 -o reduced.h5
ritz-verify -q block.h5 reduced.h5 -o verified.h5 || true

# moved FORMAT FILE OPTION...: the file, and the force in it.
moved() {
    format=$1 file=$2
    shift 2
    expect 0 '' ritz-export -q --to "$format" "$@" verified.h5 -o "$file"
    expect 0 'of the largest' rigid block.h5 "$format" "$file"
}

for reference in none mean-axis tangent; do
    for format in exudyn mbdyn sid 42 fxbody; do
        # mean axes of 42 and Radioss are those of its centre
        case $format:$reference in
        42:none) frame=basic ;;
        *:tangent) frame=46 ;;
        *) frame=centre ;;
        esac
        moved "$format" "$format.$reference" --frame "$frame" \
            --reference "$reference"
    done
done
for format in simscape chrono; do
    moved "$format" "two.$format"
    moved "$format" "one.$format" --port tip
done
for format in openfast openfast-4; do
    moved "$format" "one.$format" --port root
done
