#!/bin/sh
# A small stiff free part whose stiffness was printed with few digits.
# Usage: rounded.sh FOLDER-OF-THE-TOOLS
. "$(dirname "$0")/tap.sh"

# bar DIGITS: a free plane steel bar of 5 cm, with damping proportional to K.
bar() {
    /usr/bin/python3 -s - "$1" <<'END'
import sys
digits, n, l = int(sys.argv[1]), 10, 0.00513
E, A, I, rho = 2.07e11, 2.53e-5, 5.31e-11, 7850.0
K, M = {}, {}
a, b, g, h = E * A / l, E * I / l**3, rho * A * l / 6, rho * A * l / 420
ke = {(0, 0): a, (3, 0): -a, (3, 3): a, (1, 1): 12 * b, (2, 1): 6 * b * l,
      (2, 2): 4 * b * l * l, (4, 1): -12 * b, (4, 2): -6 * b * l,
      (4, 4): 12 * b, (5, 1): 6 * b * l, (5, 2): 2 * b * l * l,
      (5, 4): -6 * b * l, (5, 5): 4 * b * l * l}
me = {(0, 0): 2 * g, (3, 0): g, (3, 3): 2 * g, (1, 1): 156 * h,
      (2, 1): 22 * h * l, (2, 2): 4 * h * l * l, (4, 1): 54 * h,
      (4, 2): 13 * h * l, (4, 4): 156 * h, (5, 1): -13 * h * l,
      (5, 2): -3 * h * l * l, (5, 4): -22 * h * l, (5, 5): 4 * h * l * l}
for e in range(n):
    for X, x in ((K, ke), (M, me)):
        for (i, j), v in x.items():
            at = (3 * e + i + 1, 3 * e + j + 1)
            X[at] = X.get(at, 0.0) + v
for name, X, d in (("K", K, digits), ("M", M, 16)):
    with open(f"{name}.mtx", "w") as file:
        file.write("%%MatrixMarket matrix coordinate real symmetric\n"
                   f"{3 * n + 3} {3 * n + 3} {len(X)}\n")
        for (i, j), v in X.items():
            file.write(f"{i} {j} {v:.{d - 1}e}\n")
with open("dofs", "w") as dofs, open("bar.bdf", "w") as deck:
    deck.write("BEGIN BULK\n")
    for k in range(n + 1):
        dofs.write("".join(f"{k + 1} {c}\n" for c in (1, 2, 6)))
        deck.write(f"GRID,{k + 1},,{k * l:.5f},0.,0.\n")
    deck.write("ENDDATA\n")
END
    ritz-import -q --stiffness K.mtx --mass M.mtx --dofs dofs --bulk bar.bdf \
        --port end=1 --input push=11:2 --output-at tip=11:2 -o bar.h5
}

works "a bar of 9 digits" bar 9
json 0 ritz-frf bar.h5 --to-hz 20000 --damping "rayleigh 0 1e-8" \
    --method direct -o direct.h5
holds "  its range begins above what rounding rules" \
    'j["rounding"]["to_hz"] > 20 and j["rounding"]["rigid_hz"] > 0'
expect 0 "rule, at" ritz-frf bar.h5 --to-hz 20000 --method direct \
    --damping "rayleigh 0 1e-8" -o direct.h5
expect 0 "and not of the body" ritz-frf bar.h5 --from-hz 20 --to-hz 20000 \
    --method direct --damping "rayleigh 0 1e-8" -o direct.h5
json 0 ritz-frf bar.h5 --to-hz 20000 --damping "modal 0.01" -o modal.h5
holds "  a sum of modes is not ruled by it" '"rounding" not in j'

works "a bar of 7 digits" bar 7
expect 1 "1 rigid modes, the first flexible one at 10066.4 Hz; by rounding" \
    ritz-check bar.h5
expect 1 "2 rigid motions have 81.12 to 94.61 Hz" ritz-check bar.h5
expect 1 "to some of which rounding of the stiffness gives a" ritz-check bar.h5
expect 0 "" ritz-basis craig-bampton --modes 4 bar.h5 -o basis.h5
expect 0 "" ritz-reduce bar.h5 basis.h5 -o reduced.h5
expect 0 "rigid motions are held, at up to 94.61 Hz" ritz-check reduced.h5

works "a bar of 6 digits" bar 6
expect 0 "rigid eigenvalues of rounded K rule" ritz-frf bar.h5 --to-hz 90000 \
    --damping "modal 0.01" -o modal.h5
expect 0 "" ritz-basis craig-bampton --modes 4 bar.h5 -o basis.h5
expect 0 "rigid eigenvalues of rounded K" ritz-reduce bar.h5 basis.h5 \
    --band-hz 0,50000 --damping "modal 0.01" -o reduced.h5
expect 1 "negative stiffness of a rigid motion, -0.0022 of the softest" \
    ritz-check reduced.h5

printf '1..%d\n' "$count"
