#!/bin/sh
# simscape.sh FOLDER-OF-THE-TOOLS - flexible solids for Simscape Multibody of a
# body and of a system of data/dualspin, read by SciPy.
. "$(dirname "$0")/tap.sh"
. "$here/models.sh"

import_body rotor -q --port bearing=1 --units 'kg m s' -o rotor.h5
ritz-basis -q macneal-rubin --modes 6 rotor.h5 -o basis.h5
ritz-reduce -q rotor.h5 basis.h5 -o small.h5
ritz-verify -q rotor.h5 small.h5 --band-hz 0,1 -o verified.h5 || true

expect 0 '1 interface frame and' ritz-export --to simscape \
    --damping 'modal 0.01' verified.h5 -o rotor.mat
expect 0 'port bearing grid 1 at' ritz-export --to simscape verified.h5 \
    -o again.mat

# modes of the file are those of the reduced component, and the certificate is
# in it
cat >solid.py <<'PY'
import sys
import h5py
import numpy
import scipy.io
import scipy.linalg

solid = scipy.io.loadmat(sys.argv[1])
with h5py.File(sys.argv[2]) as file:
    known = scipy.linalg.eigvalsh(file["K"][:], file["M"][:])
found = scipy.linalg.eigvalsh(solid["K"], solid["M"])
most = known[-1]
assert abs(found - known).max() < 1e-10 * most, found - known
assert solid["P"].shape == (1, 3)
assert (solid["Q"] == [[1, 0, 0, 0]]).all()
x = solid["K"][:6, :6]
assert abs(x).max() < 1e-10 * most, x  # free: one frame feels no force
assert numpy.allclose(solid["C"], solid["C"].T)
assert solid["frames"][0, 0][0] == "bearing grid 1"
assert "error, measured: frequency-relative" in solid["certificate"][0]
PY
works 'SciPy reads the solid' /usr/bin/python3 -s solid.py rotor.mat verified.h5

expect 1 "there is no port 'hinge'" ritz-export --to simscape --port hinge \
    verified.h5 -o none.mat
works '  and nothing is written' test ! -e none.mat

# --- a system at a configuration, by a port of one of its bodies ------------------------

import_spacecraft
spacecraft scene 'band_hz: [0, 1]'
ritz-assemble -q scene.yaml --components body- -o system.h5
cat >system.py <<'PY'
import sys
import h5py
import scipy.io
import scipy.linalg

solid = scipy.io.loadmat(sys.argv[1])
found = scipy.linalg.eigvalsh(solid["K"], solid["M"])
with h5py.File(sys.argv[2]) as file:
    known = file["configurations/1/lambda"][:]
assert solid["P"].shape == (1, 3)
assert len(found) == len(known)
assert abs(found[8:] - known[8:]).max() < 1e-10 * known[-1]
# the body moves freely, and two hinges do while its port is held
assert (abs(found[:8]) < 1e-10 * known[-1]).all(), found[:9]
assert abs(solid["K"][:6, :6]).max() < 1e-9 * known[-1]
PY
system() {
    ritz-export --force --to simscape --at clock=90 "$@"
}
bodies='--component rotor=body-rotor.h5 --component stator=body-stator.h5
    --component platform=body-platform.h5'
# shellcheck disable=SC2086 # options are words
expect 0 '2 modes have no stiffness while the frames are held' \
    system $bodies --port platform/scan system.h5 -o system.mat
works 'SciPy reads the system' /usr/bin/python3 -s system.py system.mat \
    system.h5
# shellcheck disable=SC2086
expect 1 'depend on each other' system $bodies \
    --port stator/scan,platform/scan system.h5 -o none.mat
expect 1 "name the reduced component of 'rotor'" system system.h5 -o none.mat
