#!/bin/sh
# COMPARE by hankel, at both levels of augmentation, with a hinge about an
# oblique axis that a spring and a damper hold. Kept modes are exact, their
# damped poles are compared with those of the full system at every
# configuration, and SciPy finds the same response in the exported system.
# Usage: caged.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_spacecraft --port boom=33
for level in system component; do
    sed -e 's|build/||' -e 's/ 90, 180, 270\]/ 90]/' \
        -e "s/^augment: .*/augment: $level/" "$data/dualspin/oblique.yaml" \
        >$level.yaml
done

# damped.py AT LEVEL: print the largest difference of kept modes' damped poles
# between the full system (full.json) and the exported states (states.mat).
cat >damped.py <<'END'
import json, math, sys
import h5py, numpy as np, scipy.io

at, level = sys.argv[1:]
compared = json.load(open(f"{level}.json"))
index = [c["at"] for c in compared["configurations"]].index(at)
stage1 = h5py.File("stage1.h5")["configurations"][str(index)]
lam = stage1["lambda"][()]
flexible = np.sqrt(lam[lam > 1e-6])
kept = flexible[np.array(compared["kept"][index]) - 1]
full = np.array([complex(p["real"], p["imaginary"])
                 for p in json.load(open("full.json"))["poles"]])
space = scipy.io.loadmat("states.mat")
reduced = np.linalg.eigvals(space["A"])
worst = (0.0,)
for w in kept[kept < 2 * math.pi * 10]:
    s = full[abs(abs(full) - w).argmin()]
    z = reduced[abs(reduced - s).argmin()]
    worst = max(worst, (abs(z - s) / abs(s), abs(s) / 2 / math.pi,
                        -s.real / abs(s), -z.real / abs(z)))
print("%s, %s: damped poles of kept modes are %.1e off at most, at %.4g Hz: "
      "%.4f %% of damping, %.4f %% reduced"
      % (level, at, *worst[:2], 100 * worst[2], 100 * worst[3]))

response = h5py.File("response.h5")
hertz = response["hertz"][()]
H = response["H/real"][()] + 1j * response["H/imag"][()]
A, B, C, D = (space[k] for k in "ABCD")
mine = np.array([C @ np.linalg.solve(2j * math.pi * f * np.eye(len(A)) - A, B)
                 + D for f in hertz])
gap = abs(H.reshape(mine.shape) - mine).max() / abs(H).max()
print("response of the exported states", gap)
assert gap < 1e-9, gap
assert worst[0] < 1e-5, worst  # 4e-7 was measured, the error of stage one
END

expect 0 '' ritz-assemble -q system.yaml -o stage1.h5
for at in 0 40 90; do
    expect 0 '' ritz-assemble -q system.yaml --full --at clock=$at -o full-$at.h5
done
for level in system component; do
    json 0 ritz-compare $level.yaml -o $level.h5
    cp log.json $level.json
    holds '  kept modes are exact, and so is the gain' 'j["joined"] > 5 and
        j["removed"] and all(
            c["errors"]["frequency"] <= c["errors"]["frequency_allowed"] < 1e-5
            and c["errors"]["mac"] > 1 - 1e-8 and c["errors"]["gain"] < 1e-9
            for c in j["configurations"] if c["listed"])'
    holds '  damping is stated at every configuration' \
        'all(c["errors"]["damping"] < 1e-5 for c in j["configurations"])'
    for at in 0 40 90; do
        json 0 ritz-poles full-$at.h5 --up-to-hz 12
        cp log.json full.json
        expect 0 '' ritz-export -q --to matlab --states --at clock=$at \
            $level.h5 -o states.mat
        expect 0 '' ritz-frf -q --at clock=$at --from-hz 0.05 --to-hz 10 \
            --points 200 $level.h5 -o response.h5
        works '  damped poles and the response of what was exported' \
            /usr/bin/python3 -s damped.py clock=$at,cone=0 $level
        sed 's/^/# /' log
    done
done
expect 0 'damping-relative' ritz-verify full-40.h5 component.h5 --at clock=40 \
    --band-hz 0,3 -o verified.h5

echo "1..$count"
