#!/bin/sh
# inputs.sh FOLDER-OF-THE-TOOLS - inputs and outputs on several dofs and from
# matrices; chains, plane models and modal data without grids.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

# --- a chain of two unit masses on unit springs, and its modes as a component -

array k.mtx '2 2' 2 -1 -1 1
array m.mtx '2 2' 1 0 0 1
array b.mtx '2 1' 1 0
array c.mtx '1 2' 0 1
expect 1 '--rows, --dofs or --bulk must say' ritz-import --stiffness k.mtx \
    --mass m.mtx -o none.h5
expect 0 'rows named by  --rows' ritz-import --stiffness k.mtx --mass m.mtx \
    --rows 1 --input u=1:1 --output-at y=2:1 -o text.h5
works 'the chain takes matrices' ritz-import -q --stiffness k.mtx --mass m.mtx \
    --rows 0 --input-matrix b.mtx --input-names u --output-matrix c.mtx \
    --output-names y -o matrix.h5
awk 'BEGIN { pi = atan2(0, -1)
    h = "%%%%MatrixMarket matrix array real general\n"
    for (k = 0; k < 2; k++) {
        l[k] = (3 + (2 * k - 1) * sqrt(5)) / 2
        f[k] = sqrt(l[k]) / (2 * pi)
        s = sqrt(1 + (2 - l[k]) ^ 2)
        p[k] = 1 / s; q[k] = (2 - l[k]) / s
    }
    printf h "2 1\n%.17g\n%.17g\n", f[0], f[1] >"f.mtx"
    printf h "2 1\n%.17g\n%.17g\n", p[0], p[1] >"mb.mtx"
    printf h "1 2\n%.17g\n%.17g\n", q[0], q[1] >"mc.mtx" }'
expect 0 'rows named by  modes' ritz-import --frequencies f.mtx \
    --input-matrix mb.mtx --input-names u --output-matrix mc.mtx \
    --output-names y -o modal.h5
expect 0 'f.mtx' ritz-info modal.h5
for file in text matrix modal; do
    works "  $file responds" ritz-frf "$file.h5" --method direct \
        --from-hz 0.01 --to-hz 0.05 --points 3 --no-refine -o "$file.frf.h5"
done
for file in matrix modal; do
    works "  $file as text" /usr/bin/python3 -s - text.frf.h5 $file.frf.h5 <<'END'
import h5py, sys
def read(path):
    with h5py.File(path) as f:
        return f["H/real"][:] + 1j * f["H/imag"][:]
a, b = (read(path) for path in sys.argv[1:])
assert abs(a).max() > 0.9 and abs(a - b).max() < 1e-13 * abs(a).max(), (a, b)
END
done

# --- a damped modal form -------------------------------------------------------

works 'ratios of modes' ritz-import -q --frequencies f.mtx --ratios 0.25 \
    --input-matrix mb.mtx --output-matrix mc.mtx -o damped.h5
json 0 ritz-poles damped.h5
holds '  are those of its poles' 'len(j["poles"]) == 2 and
    all(abs(p["zeta"] - 0.25) < 1e-12 for p in j["poles"])'
expect 0 'separate-bodies' ritz-check damped.h5
works '  a basis of modes' ritz-basis -q normal-modes --modes 1 damped.h5 \
    -o basis.h5
expect 0 '' ritz-reduce damped.h5 basis.h5 -o small.h5
expect 0 'u1' ritz-info small.h5

# --- a plane frame --------------------------------------------------------------

array p.mtx '6 6' 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 \
    0 0 0 0 0 1
expect 0 'u' ritz-import --mass p.mtx --rows 126 \
    --input 'u=1:1,2:2*-0.5' --output-at 'gap=1:6,2:6*-1/vel@1e-3' -o plane.h5
expect 0 'gap' ritz-info plane.h5

# --- usage ------------------------------------------------------------------------

expect 2 'are for --state-space' ritz-import --mass m.mtx --input-names u \
    -o none.h5
expect 2 'are for --state-space' ritz-import --mass m.mtx --output-names y \
    --input-matrix b.mtx -o none.h5
expect 2 'are those of --frequencies' ritz-import --mass m.mtx --ratios 0.1 \
    -o none.h5
expect 2 'nothing to import' ritz-import --rows 1 -o none.h5
expect 2 '--input-matrix is not for it' ritz-import --state-space A=a.mtx \
    --input-matrix b.mtx -o none.h5
expect 1 'cancel each other' ritz-import --mass p.mtx --rows 126 \
    --input 'u=1:1,1:1*-1' -o none.h5
expect 1 'frequencies make a whole component' ritz-import --frequencies f.mtx \
    --mass m.mtx -o none.h5
echo "1..$count"
