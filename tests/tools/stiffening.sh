#!/bin/sh
# stiffening.sh FOLDER-OF-THE-TOOLS - geometric stiffness in exported files: as
# terms, as matrices, or with a message that it is left out.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

rotor=$data/dualspin/rotor.op4
import_body rotor -q --port bearing=1 --input torque=1:6 --units "kg m s" \
    --geometric-stiffness "$rotor:KGG@spin_zz" \
    --geometric-stiffness "$rotor:MGG@pull" -o rotor.h5
ritz-basis -q craig-bampton --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q rotor.h5 small.h5 --band-hz 0,5 -o verified.h5

# --- terms ------------------------------------------------------------------

for to in mbdyn sid; do
    expect 0 "stiffening spin_zz: geometric stiffness of load 'spin_zz'" \
        ritz-export --to $to --stiffening spin_zz verified.h5 -o rotor.$to
    expect 0 "load 'pull' is left out: name its term by --stiffening" \
        ritz-export --to $to --stiffening spin_zz verified.h5 -o rotor.$to
    expect 0 "load 'spin_zz' is left out: name its term by --stiffening" \
        ritz-export --to $to verified.h5 -o bare.$to
    expect 1 "is 'pull' meant" ritz-export --to $to \
        --stiffening accel_x=pul verified.h5 -o none.$to
    expect 1 'export with --frame basic' ritz-export --to $to \
        --frame centre --stiffening spin_zz verified.h5 -o none.$to
    works '  and nothing is written' test ! -e none.$to
done
expect 0 '** RECORD GROUP 19, ' cat rotor.mbdyn
works 'without terms there is no group 19' sh -c \
    '! grep -q "RECORD GROUP 19" bare.mbdyn'
# KG is K: group 19, behind its count and tag, is group 10
works 'group 19 holds the terms in the modes of the file' awk '
    /^\*\* RECORD GROUP/ { group = $4 + 0; next }
    !/^\*\*/ && (group == 10 || group == 19) {
        for (k = 1; k <= NF; k++) x[group, n[group]++] = $k }
    END { m = n[10]
          if (m != 36 || n[19] != m + 2 || x[19, 0] != 1 || x[19, 1] != 3)
              exit 1
          for (k = 0; k < m; k++) {
              gap = x[10, k] - x[19, k + 2]
              largest = x[10, k] > largest ? x[10, k] : largest
              worst = gap * gap > worst ? gap * gap : worst }
          exit !(worst < 1e-18 * largest * largest) }' rotor.mbdyn
works 'the first line of SID says whether there is stiffening' sh -c \
    'head -n 1 rotor.sid | grep -q "with geometric stiffening" &&
     head -n 1 bare.sid | grep -q "no geometric stiffening"'
expect 2 'has no terms of geometric stiffness' ritz-export --to fmu \
    --stiffening spin_zz verified.h5 -o none.fmu

# --- matrices ---------------------------------------------------------------

expect 0 "KG1  12 x 12, KG of load 'spin_zz'" ritz-export --to output4 \
    verified.h5 -o rotor.op4
expect 0 "KG2  12 x 12, KG of load 'pull'" ritz-export --to matlab \
    --matrix K,KG:pull verified.h5 -o rotor.mat
expect 0 'KG1' ritz-export --to matrix-market verified.h5 -o m-%.mtx
# rigid columns of K are free of the rounding of the source, 2e-9
works 'KG of K is K' /usr/bin/python3 -s - <<'END'
import numpy as np
import scipy.io
K, KG = (scipy.io.mmread(f"m-{name}.mtx") for name in ("K", "KG1"))
K, KG = (A.toarray() if hasattr(A, "toarray") else A for A in (K, KG))
assert abs(K - KG).max() <= 1e-8 * abs(K).max()
END
expect 1 "has no 'KG:tip'" ritz-export --to output4 --matrix KG:tip \
    verified.h5 -o none.op4

expect 0 'KG1 is for K2GG = KG1' ritz-export --to dmig verified.h5 -o rotor.dmig
expect 0 "KG1 is of a unit of load 'spin_zz': K2GG = KAAX, X*KGn" cat rotor.dmig
expect 0 '' ritz-import -q --stiffness rotor.dmig:KAAX --mass rotor.dmig:MAAX \
    --geometric-stiffness rotor.dmig:KG1@spin_zz \
    --geometric-stiffness rotor.dmig:KG2@pull --bulk rotor.dmig -o again.h5
works 'a reader of DMIG finds both loads again' /usr/bin/python3 -s - <<'END'
import h5py
import numpy as np

def entries(item):
    """Sorted values: scalar points have other rows than their coordinates."""
    A = item["matrix"][()].ravel() if "matrix" in item else item["data"][()]
    return np.sort(A[A != 0])
with h5py.File("again.h5") as a, h5py.File("verified.h5") as b:
    for load in "spin_zz", "pull":
        x, y = entries(a["KG"][load]), entries(b["KG"][load])
        large = abs(y).max()
        assert abs(x[abs(x) > 1e-6 * large] -
                   y[abs(y) > 1e-6 * large]).max() <= 1e-9 * large
END

# --- nowhere ----------------------------------------------------------------

# leaves TO OPTION...: the export says once which loads it leaves out.
leaves() {
    to=$1
    shift
    works "$to is written" sh -c '"$@" >said 2>&1' - ritz-export \
        --to "$to" "$@" verified.h5 -o "out-$to.op4"
    expect 0 "loads 'spin_zz', 'pull' is left out: $to has no place for it" \
        grep 'geometric stiffness (KG)' said
    works '  which is said once' sh -c \
        'test "$(grep -c "geometric stiffness" said)" = 1'
}
leaves 42
leaves chrono
leaves exudyn
leaves fmu
leaves fxbody
leaves openfast
leaves openfast-4
leaves simscape
leaves superelement
leaves uff
expect 0 'geometric stiffness of 2 loads is left out: a state space' \
    ritz-export --to output4 --states verified.h5 -o states.op4

echo "1..$count"
