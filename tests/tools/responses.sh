#!/bin/sh
# responses.sh FOLDER-OF-THE-TOOLS - engines of ritz-frf and points that keep a
# tolerance: what is asked, chosen, refused, and what the file says of it.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

ritz-import -q --stiffness "$data/chain/chain.K.mtx" \
    --mass "$data/chain/chain.M.mtx" --dofs "$data/chain/chain.dofs" \
    --input tip=10:1 --output-at root=1:1 -o plain.h5
import_chain --input tip=10:1 --output-at root=1:1 -o damped.h5

expect 0 'KenneyStubberudLaub1992' ritz-frf --list
expect 2 "no method 'krilov', is 'krylov' meant?" \
    ritz-frf plain.h5 --method krilov --to-hz 0.3 -o none.h5
expect 0 'method modal: without damping matrices' \
    ritz-frf plain.h5 --to-hz 0.3 --damping 'modal 1e-3' -o modal.h5
expect 0 'method krylov: damping matrices' \
    ritz-frf damped.h5 --to-hz 0.3 -o krylov.h5
for engine in direct rational modal; do
    expect 0 "$engine response" ritz-frf damped.h5 --to-hz 0.3 \
        --points-of krylov.h5 --method $engine -o $engine.h5
done
expect 0 'vectors more' ritz-frf plain.h5 --to-hz 0.3 --method krylov \
    --damping 'modal 1e-4' --tolerance 1e-3 -o followed.h5
expect 1 'is the frequency of an undamped mode' ritz-frf plain.h5 --to-hz 0.3 --method krylov \
    --tolerance 1e-3 -o none.h5
expect 2 'one of the two' ritz-frf plain.h5 --points-of modal.h5 \
    --tolerance 1e-3 -o none.h5

# Three dampers in a chain of 2101 masses of 1 kg, springs of 1e6 N/m: they damp
# modes above those that are summed too.
awk 'BEGIN {
    n = 2101; head = "%%MatrixMarket matrix coordinate real symmetric"
    print head > "row.K.mtx"; print n, n, 2 * n - 1 > "row.K.mtx"
    print head > "row.M.mtx"; print n, n, n > "row.M.mtx"
    print head > "row.D.mtx"; print n, n, 3 > "row.D.mtx"
    for (i = 1; i <= n; i++) {
        print i, i, (i < n ? 2e6 : 1e6) > "row.K.mtx"
        if (i < n) print i + 1, i, -1e6 > "row.K.mtx"
        print i, i, 1 > "row.M.mtx"
        print i, 1 > "row.dofs"
    }
    print 420, 420, 1000 > "row.D.mtx"; print 1050, 1050, 500 > "row.D.mtx"
    print 1680, 1680, 700 > "row.D.mtx"
}'
ritz-import -q --stiffness row.K.mtx --mass row.M.mtx --damping row.D.mtx \
    --dofs row.dofs --input tip=2101:1 --output-at root=700:1 -o row.h5
expect 0 'direct instead: modes above 6 Hz are summed undamped: off by' \
    ritz-frf row.h5 --method modal --to-hz 2 --tolerance 1e-2 -o held.h5
expect 0 'compared with direct; --method krylov leaves nothing out' \
    ritz-frf row.h5 --method modal --to-hz 2 -o row-modal.h5
expect 0 'compared with direct, up to 2 Hz' ritz-simulate row.h5 \
    --up-to-hz 6 --seconds 0.1 --step 0.01 --input tip=step -o row-sim.h5

# By SciPy: full complex systems, and cubics between the points of the file.
if /usr/bin/python3 -s -c 'import h5py, scipy.sparse' 2>log; then
    cat >check.py <<'END_OF_CHECK'
import h5py, numpy, scipy.interpolate, scipy.io, scipy.linalg, scipy.sparse
import scipy.sparse.linalg, sys
def matrix(f, name):
    g = f[name]
    return scipy.sparse.csc_matrix((g["data"][:], g["indices"][:],
                                    g["indptr"][:]), g.attrs["shape"]).toarray()
def response(name):
    with h5py.File(name) as f:
        return (f["hertz"][:], f["H/real"][:, 0, 0] + 1j * f["H/imag"][:, 0, 0],
                dict(f.attrs))
with h5py.File("damped.h5") as f:
    K, M, D = (matrix(f, x) for x in "KMD")
    b, c = f["inputs/B"][:, 0], f["outputs/C"][0]
def full(hz, D):
    w = 2 * numpy.pi * hz
    return c @ numpy.linalg.solve(K + 1j * w * D - w * w * M, b)
for name, limit in ("krylov", 1e-9), ("direct", 1e-9), ("rational", 3e-9):
    hz, H, _ = response(name + ".h5")
    error = max(abs(h - full(f, D)) for f, h in zip(hz, H)) / abs(H).max()
    assert error <= limit, (name, error)
row = [scipy.io.mmread(f"row.{x}.mtx").tocsc() for x in "KMD"]
load = numpy.zeros(row[0].shape[0])
load[2100] = 1
hz, H, attributes = response("held.h5")
worst = 0
for f, h in list(zip(hz, H))[::7]:
    w = 2 * numpy.pi * f
    Z = (row[0] + 1j * w * row[2] - w * w * row[1]).tocsc()
    worst = max(worst, abs(h - scipy.sparse.linalg.spsolve(Z, load)[699]))
assert worst <= 1e-2 * abs(H).max(), ("held", worst / abs(H).max())
lam, phi = scipy.linalg.eigh(K, M)
E = M @ phi @ numpy.diag(2e-4 * numpy.sqrt(abs(lam))) @ phi.T @ M
hz, H, attributes = response("followed.h5")
assert attributes["interpolation"] in (b"cubic", "cubic"), attributes
assert attributes["tolerance"] == 1e-3
worst = 0
for f in numpy.random.default_rng(1992).uniform(hz[0], hz[-1], 1000):
    i = min(max(numpy.searchsorted(hz, f) - 2, 0), len(hz) - 4)
    x, h = hz[i:i + 4], H[i:i + 4]
    got = sum(h[j] * numpy.prod([(f - x[m]) / (x[j] - x[m])
                                 for m in range(4) if m != j]) for j in range(4))
    worst = max(worst, abs(got - full(f, E)) / abs(H).max())
assert worst <= 1e-3, worst
print(len(hz), worst)
END_OF_CHECK
    works 'SciPy finds the same, between points too' /usr/bin/python3 -s check.py
else
    echo '# skipped: no SciPy, responses are not held to it'
fi
echo "1..$count"
