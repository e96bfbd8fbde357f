"""peer_exudyn.py NAME.npz - the job by Exudyn: 50 modes with the interface
held, and static modes of its four patches, each of which moves rigidly. Prints
one JSON object."""
import contextlib
import io
import json
import sys
import time

import exudyn.FEM
import numpy
import scipy.sparse

PATCHES, MODES = 4, 50


def main():
    times = [time.monotonic()]
    with numpy.load(sys.argv[1]) as f:
        K, M = (scipy.sparse.csr_matrix(scipy.sparse.csc_matrix(
            (f[c + "_data"], f[c + "_indices"], f[c + "_indptr"]),
            tuple(f["shape"]))) for c in "KM")
        port, position = f["port"], f["position"]
    fem = exudyn.FEM.FEMinterface()
    fem.nodes = {"Position": position}
    fem.massMatrix, fem.stiffnessMatrix = M, K
    # patches lie at the corners of the interface
    grids = numpy.unique(port // 3)
    middle = position[grids].mean(axis=0)
    corner = (position[grids, :2] > middle[:2]) @ [1, 2]
    patches = [grids[corner == k].tolist() for k in range(PATCHES)]
    times.append(time.monotonic())
    with contextlib.redirect_stdout(io.StringIO()):  # it reports as it goes
        fem.ComputeHurtyCraigBamptonModes(patches, MODES, True)
    times.append(time.monotonic())
    print(json.dumps({
        "phases": dict(zip(["read", "modes"], numpy.diff(times).tolist())),
        "values": sorted(map(float, fem.eigenValues))[:MODES]}))


main()
