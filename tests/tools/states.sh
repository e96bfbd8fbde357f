#!/bin/sh
# states.sh FOLDER-OF-THE-TOOLS - state spaces through the tools: out of matrix
# files, reduced, measured, and into MAT and Matrix Market files.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"
building=${RITZ_EXTERNAL_DATA:?is not set}/state_space/building

# --- import -----------------------------------------------------------------------

# E x' = A x + B u of two states, with H = 1/(2 s + 1) and 1/(s + 10)
array a.mtx '2 2' -1 0 0 -10
array b.mtx '2 1' 1 1
array c.mtx '2 2' 1 0 0 1
array e.mtx '2 2' 2 0 0 1
array bad.mtx '3 1' 1 1 1
array flat.mtx '2 2' 1 1 1 1
expect 0 'state space, 2 states' ritz-import \
    --state-space A=a.mtx,B=b.mtx,C=c.mtx,E=e.mtx --input-names force \
    --output-names slow@0.5,fast --units 'kg m s' -o two.h5
expect 0 'slow, limit 0.5' ritz-info two.h5
expect 1 "'E' is singular" ritz-import \
    --state-space A=a.mtx,B=b.mtx,C=c.mtx,E=flat.mtx -o none.h5
expect 1 "'B' is 3 x 1 where 2 x 1 is due" ritz-import \
    --state-space A=a.mtx,B=bad.mtx,C=c.mtx -o none.h5
expect 1 "there is no 'C'" ritz-import --state-space A=a.mtx,B=b.mtx -o none.h5
expect 2 '--port is not for it' ritz-import --state-space A=a.mtx,B=b.mtx \
    --port tip=1 -o none.h5
expect 2 'are for --state-space' ritz-import --mass a.mtx --input-names u \
    -o none.h5

# --- what takes a state space, and what does not --------------------------------------

expect 0 '0.5' ritz-poles two.h5
expect 1 'damped as it is' ritz-poles two.h5 --damping 'modal 0.1'
expect 0 'states response' ritz-frf two.h5 --to-hz 1 -o response.h5
expect 0 'not applicable: no input and output of one name' ritz-check two.h5
expect 1 'holds a state space, not a component' ritz-basis craig-bampton \
    --modes 1 two.h5 -o none.h5
expect 1 'methods that take a state space: balanced' ritz-basis rubin \
    --modes 1 two.h5 -o none.h5
expect 1 'is a state space: --method direct is for components, here are auto' \
    ritz-frf two.h5 --to-hz 1 --method direct -o none.h5

# --- out again, to the bit -------------------------------------------------------------

expect 0 "E x' = A x + B u" ritz-export --to matlab two.h5 -o two.mat
expect 0 'a cell array' ritz-info two.mat
expect 0 'certificate ' ritz-info two.mat
mv two.mat first.mat
ritz-export --to matlab two.h5 -o two.mat >said.txt
same 'the same run writes the same MAT file' first.mat two.mat
expect 0 '2 states' ritz-import --state-space two.mat --input-names force \
    --output-names slow@0.5,fast --units 'kg m s' -o back.h5
for file in two back; do
    ritz-info --json "$file.h5" | grep -A 6 '"checksums"' >"$file.sums"
done
same 'a MAT file keeps every bit' two.sums back.sums
expect 1 'holds one matrix' ritz-export --to matrix-market --matrix A,B two.h5 \
    -o two.mtx
expect 0 'E  2 x 2' ritz-export --to matrix-market two.h5 -o 'two-%.mtx'
expect 0 '2 states' ritz-import --input-names force --units 'kg m s' \
    --output-names slow@0.5,fast -o back.h5 \
    --state-space A=two-A.mtx,B=two-B.mtx,C=two-C.mtx,D=two-D.mtx,E=two-E.mtx
ritz-info --json back.h5 | grep -A 6 '"checksums"' >back.sums
same 'Matrix Market keeps every bit' two.sums back.sums
expect 1 "'two.mat:input_names' is a cell array" ritz-import \
    --state-space A=two.mat:input_names,B=b.mtx,C=c.mtx -o none.h5
head -c 500 two.mat >cut.mat
expect 1 'are left' ritz-import --state-space cut.mat -o none.h5

# --- a component against states that were made of it -----------------------------------

import_chain --input tip=10:1 --output-at root=1:1 -o chain.h5
ritz-basis -q lanczos-one-sided --modes 12 --operator inverse chain.h5 \
    -o basis.h5
ritz-reduce -q chain.h5 basis.h5 -o small.h5
expect 0 'static-gain-relative' ritz-verify chain.h5 small.h5 -o verified.h5
expect 1 '--limit-frequency is not for it' ritz-verify chain.h5 small.h5 \
    --limit-frequency 1 -o none.h5
expect 1 'of 2 limits not met' ritz-verify chain.h5 small.h5 \
    --limit-h-infinity 1e-6 -o failed.h5
expect 0 'errors measured by ritz-verify' ritz-export --to matlab verified.h5 \
    -o small.mat
ritz-basis -q normal-modes --modes 3 chain.h5 -o basis.h5
ritz-reduce -q chain.h5 basis.h5 -o modes.h5
expect 1 'is a state space and' ritz-verify two.h5 modes.h5 -o none.h5
expect 1 'is no state space, --limit-h-infinity is not for it' ritz-verify chain.h5 \
    modes.h5 --limit-h-infinity 1 -o none.h5

# Matrices of a component out of a MAT file, and what was written into one.
if /usr/bin/python3 -s -c 'import scipy.io' 2>log; then
    cat >pack.py <<'END'
import scipy.io
scipy.io.savemat("chain.mat", {k: scipy.io.mmread(f"{d}/chain.{k}.mtx")
                               for d in [__import__("sys").argv[1]]
                               for k in "KMD"}, do_compression=True)
END
    /usr/bin/python3 -s pack.py "$data/chain"
    ritz-import -q --stiffness chain.mat:K --mass chain.mat:M \
        --damping chain.mat:D --dofs "$data/chain/chain.dofs" --input tip=10:1 \
        --output-at root=1:1 -o packed.h5
    for file in chain packed; do
        ritz-info --json "$file.h5" | grep -A 4 '"checksums"' >"$file.sums"
    done
    same 'SciPy and Matrix Market give one component' chain.sums packed.sums
    cat >read.py <<'END'
import h5py, numpy, scipy.io
m = scipy.io.loadmat("two.mat")
with h5py.File("two.h5") as f:
    for k in "ABCDE":
        assert numpy.array_equal(m[k], f[k][:]), k
assert [str(x[0][0]) for x in m["output_names"]] == ["slow", "fast"]
assert m["limits"][0, 0] == 0.5 and numpy.isnan(m["limits"][1, 0])
END
    works 'SciPy reads what was exported' /usr/bin/python3 -s read.py
else
    echo '# skipped: no SciPy, MAT files of others are not tried'
fi

# --- a benchmark of a public collection ---------------------------------------------------

if [ -r "$building/A.mtx" ]; then
    expect 0 '48 states' ritz-import -o building.h5 --state-space \
        "A=$building/A.mtx,B=$building/B.mtx,C=$building/C.mtx"
    json 0 ritz-basis balanced --modes 10 building.h5 -o basis.h5
    # as the collection's authors store them; a value rounds by some 1e-11 of
    # the largest
    holds '  has the Hankel values of its authors' 'near(
        j["hankel_values"][:4], [2.50350021729587452e-03,
        2.42849186089177330e-03, 1.93151255410726422e-03,
        1.92831424704422404e-03], 1e-12)'
    expect 0 'h-infinity-bound' ritz-reduce building.h5 basis.h5 -o ten.h5
    json 0 ritz-verify building.h5 ten.h5 --band-hz 0,20 -o verified.h5
    # a search over frequencies and a Lyapunov equation, by SciPy
    holds '  is as far from it as an independent computation says' '(lambda m:
        abs(m["h-infinity"] / 6.02511234436e-4 - 1) < 1e-8 and
        abs(m["h2-relative"] / 0.199850182182 - 1) < 1e-9 and
        m["h-infinity"] <= m["h-infinity-bound"] * (1 + 1e-12))(
        {x["name"]: x["value"] for x in j["measures"]})'
    expect 0 'A  10 x 10' ritz-export --to matlab verified.h5 -o ten.mat
    json 0 ritz-info verified.h5
    holds '  keeps its errors' 'j["errors"][0]["name"] == "h-infinity" and
        j["states"] == 10 and j["stability"] == "stable"'
else
    echo '# skipped: no external data'
fi
echo "1..$count"
