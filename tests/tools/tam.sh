#!/bin/sh
# Tests of test-analysis models, tangential interpolation and interface modes as
# a user meets them. Usage: tam.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

# A grid of masses 1 that move along z, springs of 1 between neighbours: free,
# nx x ny, at (s x, y, 0), numbered from `first` along y first.
lattice() {
    awk -v nx="$1" -v ny="$2" 'BEGIN {
        for (x = 0; x < nx; x++)
            for (y = 0; y < ny; y++) {
                i = x * ny + y + 1
                if (x < nx - 1) put(i, i + ny)
                if (y < ny - 1) put(i, i + 1)
            }
        print "%%MatrixMarket matrix coordinate real symmetric"
        print nx * ny, nx * ny, n + nx * ny
        for (i = 1; i <= nx * ny; i++) print i, i, d[i]
        for (k = 1; k <= n; k++) print below[k], left[k], -1
    }
    function put(i, j) { d[i]++; d[j]++; n++; below[n] = j; left[n] = i }'
}
masses() {
    awk -v n="$1" 'BEGIN {
        print "%%MatrixMarket matrix coordinate real symmetric"
        print n, n, n
        for (i = 1; i <= n; i++) print i, i, 1
    }'
}
grids() {
    awk -v nx="$1" -v ny="$2" -v side="$3" -v first="$4" 'BEGIN {
        for (x = 0; x < nx; x++)
            for (y = 0; y < ny; y++)
                printf "GRID,%d,,%d.,%d.,0.\n", first + x * ny + y, side * x, y
    }'
}
dofs() {
    awk -v n="$1" -v first="$2" 'BEGIN {
        for (i = 0; i < n; i++) print first + i, 3
    }'
}
lattice 6 8 >k.mtx
masses 48 >m.mtx
for side in a b; do
    [ $side = a ] && sign=-1 first=1 || sign=1 first=101
    grids 6 8 "$sign" "$first" >$side.bdf
    dofs 48 "$first" >$side.dofs
done

expect 0 'a.h5' ritz-import --stiffness k.mtx --mass m.mtx --dofs a.dofs \
    --bulk a.bdf --port edge=1-8 --port sensors=1,8,29,41,48 -o a.h5
expect 0 'b.h5' ritz-import --stiffness k.mtx --mass m.mtx --dofs b.dofs \
    --bulk b.bdf --port edge=101-108 -o b.h5

# --- measured dofs ------------------------------------------------------------

expect 0 '5 constraint' ritz-basis irs --attach sensors a.h5 -o irs.h5
expect 0 'a.h5' ritz-reduce a.h5 irs.h5 -o ra.h5
expect 2 'irs has no modes to choose' \
    ritz-basis irs --modes 3 a.h5 -o irs.h5
expect 1 'irs: nothing is attached' ritz-basis irs --attach '' a.h5 -o irs.h5

expect 0 '5 constraint' ritz-basis serep --modes 4 --attach sensors a.h5 \
    -o serep.h5
expect 0 'a.h5' ritz-reduce a.h5 serep.h5 -o ra.h5
expect 0 'frequency-relative' ritz-verify a.h5 ra.h5 --band-hz 0,0.1 \
    --limit-frequency 1e-9 -o v.h5
expect 0 '3 of 5 attached dofs are coordinates, which are enough: grid ' \
    ritz-basis serep --modes 2 --attach sensors a.h5 -o serep.h5
expect 1 '5 attached dof(s) cannot show 6 modes, 1 rigid ones among them' \
    ritz-basis serep --modes 5 --attach sensors a.h5 -o serep.h5

# --- tangential ---------------------------------------------------------------

expect 0 '1 rigid, 6 krylov' ritz-basis tangential --modes 6 \
    --loads attached --attach sensors --damping 'modal 0.02' a.h5 -o t.h5
expect 0 'points settled after ' ritz-basis tangential --modes 6 \
    --loads attached --attach sensors --damping 'modal 0.02' a.h5 -o t.h5
expect 0 'a.h5' ritz-reduce a.h5 t.h5 -o ra.h5
expect 0 '5 response(s) interpolated' ritz-basis tangential --modes 5 \
    --shift-hz 0.05 --attach sensors a.h5 -o t.h5
expect 1 '0 Hz is a pole of it' ritz-basis tangential --modes 5 \
    --shift-hz 0 --attach sensors a.h5 -o t.h5
expect 1 'there is no load to respond to' \
    ritz-basis tangential --modes 5 --attach '' a.h5 -o t.h5

# --- interface modes ----------------------------------------------------------

expect 0 '1 rigid, 10 normal, 4 interface' ritz-basis craig-bampton \
    --modes 10 --interface-modes 4 --attach edge a.h5 -o cb.h5
expect 0 '1 rigid, 2 interface' \
    ritz-basis guyan --interface-modes 2 --attach edge a.h5 -o g.h5
expect 2 "macneal-rubin has no 'interface_modes' to choose" ritz-basis \
    macneal-rubin --modes 3 --interface-modes 4 a.h5 -o mr.h5
expect 2 'no number of interface modes' ritz-basis craig-bampton \
    --modes 10 --interface-modes 0 a.h5 -o cb.h5
cat >scene.yaml <<'END'
scene: two lattices
components:
  a: {model: a.h5, basis: craig-bampton, modes: 10, interface_modes: 6, attach: [edge]}
  b: {model: b.h5, basis: craig-bampton, modes: 10, attach: [edge]}
joints:
  - {name: seam, between: [a/edge, b/edge], type: fixed}
END
expect 0 'system.h5' ritz-assemble scene.yaml -o system.h5
expect 0 'full.h5' ritz-assemble --full scene.yaml -o full.h5
expect 0 'frequency-relative' ritz-verify full.h5 system.h5 --band-hz 0,0.08 \
    --limit-frequency 1e-3 -o v.h5

printf '1..%d\n' "$count"
