#!/bin/sh
# lanczos.sh FOLDER-OF-THE-TOOLS - bases of states, the state spaces that they
# make, and what is not exported.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_chain --input tip=10:1 --output-at root=1:1 -o chain.h5
printf '%s\n' '%%MatrixMarket matrix coordinate real symmetric' '2 2 2' \
    '1 1 1' '2 2 1' >small.K.mtx
printf '1 1\n2 1\n' >small.dofs

# --- bases ----------------------------------------------------------------------

expect 0 'basis of 12 columns for 20 states' ritz-basis lanczos-one-sided \
    --modes 12 --operator inverse chain.h5 -o one.h5
expect 0 '12 state' ritz-basis lanczos-two-sided --modes 12 \
    --operator inverse chain.h5 -o two.h5
expect 0 'W ' ritz-info two.h5
expect 0 'asked for: the inputs control 20 of 20; there are 20' \
    ritz-basis lanczos-one-sided --modes 30 chain.h5 -o all.h5
expect 1 'serious breakdown at the first block: C B is zero' \
    ritz-basis lanczos-two-sided --modes 4 chain.h5 -o none.h5
expect 1 'by their number' ritz-basis lanczos-one-sided --up-to-hz 1 chain.h5 \
    -o none.h5
expect 2 "has no 'gramian'" ritz-basis lanczos-two-sided --modes 4 \
    --gramian inputs chain.h5 -o none.h5
expect 2 'lanczos-one-sided' ritz-basis lanczos-onesided --modes 4 chain.h5 \
    -o none.h5

# --- state spaces -----------------------------------------------------------------

expect 0 'stable: pole at -0.00011169' ritz-reduce chain.h5 one.h5 -o small.h5
expect 0 "warning: 'grows.h5' is unstable: pole at +0.15457 +- 1.193i" \
    ritz-reduce chain.h5 two.h5 -o grows.h5
json 0 ritz-reduce chain.h5 two.h5 -o again.h5
holds '  says so, with its poles' 'j["kind"] == "state-space" and
    j["states"] == 12 and j["stability"] == "unstable" and
    len(j["poles"]) == 12 and
    near([max(p[0] for p in j["poles"])], [0.154570], 1e-6) and
    j["estimates"][0]["name"] == "growth-relative"'
json 0 ritz-info small.h5
holds '  is stable' 'j["stability"] == "stable" and j["inputs"] == ["tip"] and
    all(p[0] < 0 for p in j["poles"]) and sorted(j["checksums"]) == list("ABCD")'
expect 0 'h-infinity-relative' ritz-verify chain.h5 small.h5 -o verified.h5
ritz-import -q --stiffness small.K.mtx --mass small.K.mtx --dofs small.dofs \
    -o other.h5
expect 1 "is a basis for 10 dofs, 'other.h5' has 2" ritz-reduce other.h5 two.h5 \
    -o none.h5

# --- responses: the first moments are kept, so low frequencies agree ---------------

expect 0 '530 points' ritz-frf --method direct --to-hz 0.5 chain.h5 -o full.h5
expect 0 'states response, 530 points' ritz-frf --points-of full.h5 small.h5 \
    -o response.h5
cat >agree.py <<'END'
import h5py, numpy
def read(name):
    f = h5py.File(name)
    return f["hertz"][:], f["H/real"][:].ravel() + 1j * f["H/imag"][:].ravel()
f, full = read("full.h5")
f, small = read("response.h5")
off = numpy.abs(small - full)[f < 0.1].max() / numpy.abs(full).max()
print("agree" if off < 1e-5 else off)  # measured: 3.0e-6
END
expect 0 'agree' /usr/bin/python3 -s agree.py
expect 1 'damped as it was made' ritz-frf --to-hz 1 --damping 'modal 0.1' \
    small.h5 -o none.h5
expect 1 'direct is for components' ritz-frf --to-hz 1 --method direct \
    small.h5 -o none.h5

# --- export ---------------------------------------------------------------------

for matrix in A B C D; do
    expect 0 "  $matrix  " ritz-export --to matrix-market --matrix $matrix \
        small.h5 -o $matrix.mtx
done
expect 0 'stable: pole at' ritz-export --to output4 small.h5 -o small.op4
expect 1 'written to its end: File too large' \
    sh -c 'ulimit -f 1; ritz-export -q --to output4 small.h5 -o none.op4'
expect 0 'A ' ritz-info small.op4
expect 1 "no matrix 'K', there are A, B, C, D and E" ritz-export --to output4 \
    --matrix K small.h5 -o none.op4
expect 1 "'grows.h5' is unstable: pole at +0.15457 +- 1.193i rad/s" \
    ritz-export --to output4 grows.h5 -o none.op4
expect 0 "warning: 'grows.h5' is unstable" ritz-export --to output4 --force \
    grows.h5 -o grows.op4
ritz-basis -q lanczos-two-sided --modes 5 --operator inverse chain.h5 -o five.h5
ritz-reduce -q chain.h5 five.h5 -o five-small.h5
expect 1 'made by lanczos-two-sided, which promises no stability (now stable' \
    ritz-export --to output4 five-small.h5 -o none.op4
expect 1 'a reduced component' ritz-export --to exudyn small.h5 -o none.h5
expect 0 'stable' ritz-export --to output4 --force five-small.h5 -o five.op4

# what a reduced component is refused for: a spring that pushes
ritz-basis -q full chain.h5 -o full-basis.h5
ritz-reduce -q chain.h5 full-basis.h5 -o reduced.h5
expect 0 'stable: pole at' ritz-export --to output4 reduced.h5 -o reduced.op4
cat >push.py <<'END'
import h5py
with h5py.File("reduced.h5", "a") as f:
    K = f["K"][:]
    K[0, 0] -= 2.5
    del f["K"]
    f["K"] = K
END
/usr/bin/python3 -s push.py
expect 1 'is unstable: stiffness with a negative eigenvalue' \
    ritz-export --to output4 reduced.h5 -o none.op4

echo "1..$count"
