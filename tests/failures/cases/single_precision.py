"""Export in single precision

A reduced free body holds its rigid motion as differences of large numbers. Written as floats, as OUTPUT4 of single precision has them, or with the seven digits of a field of ten columns, they do not cancel: the "rigid" modes of a slender beam, of 0.2 Hz in bending, come back at some percent of that, part of them imaginary, so that the body swings on springs that are not there, or grows.

Ritz writes doubles, and 17 digits where a format is text. If fewer are asked for, the rounded matrices are what it checks before it writes, and it refuses those that make the body unstable. DMIG cards have no more than 11 to 15 digits: the export measures what they do to rigid motions and frequencies, and says so.
"""
import h5py
import numpy as np
import scipy.io
import scipy.linalg as la
import scipy.sparse

import models
import naive

GROUP = "Matrices as they come"


def rigid_part(K, M, first):
    """Largest |frequency| of the six that should be zero, over the first."""
    return np.sqrt(np.max(np.abs(la.eigvalsh(K, M)[:6])) / first)


def run(it):
    beam = models.turned(models.space_beam(20, (0.003, 0.007)),
                         (0.3, -0.5, 0.7))
    first = la.eigvalsh(beam.K, beam.M)[6]
    path = it.component("beam", beam, "--port", "left=1", "--port", "right=21")
    reduced, _, _ = it.reduce(path, "craig-bampton", "--modes", 8)
    with h5py.File(it.folder / reduced) as file:
        K, M = file["K"][:], file["M"][:]
    single = rigid_part(K.astype("f4").astype("f8"),
                        M.astype("f4").astype("f8"), first)
    it.holds(single > 1e-3, f"naive: floats give rigid modes at {single:.2g} "
             "of the first flexible frequency")

    seven = [np.vectorize(lambda x: float(f"{x:.6e}"))(A) for A in (K, M)]
    text = rigid_part(*seven, first)
    it.holds(text > 1e-3, f"naive: seven digits give rigid modes at {text:.2g}")

    it.tool("export", "--to", "matrix-market", reduced, "-o", "doubles-%.mtx")

    def read(name):
        A = scipy.io.mmread(it.folder / f"doubles-{name}.mtx")
        return A.toarray() if scipy.sparse.issparse(A) else A

    double = rigid_part(read("K"), read("M"), first)
    it.holds(double < 1e-4, f"Ritz: 17 digits give {double:.1g}")
    it.holds(np.array_equal(read("K"), K), "Ritz: every bit of K")
    it.says("negative stiffness of a rigid motion", 1, "export", "--to", "output4", "--text",
            "--digits", 7, reduced, "-o", "seven.op4")
    it.says("rigid motions r, of largest entry 1: max|K r| / max|K| is", 0,
            "export", "--to", "dmig", reduced, "-o", "part.dmig")
    it.row("rigid modes at 0.1 % of the first frequency and more", "0",
           "doubles to the last bit; with `--digits 7` what is written is "
           "checked, and refused")
