#!/usr/bin/python3 -s
"""models.py NAME FOLDER - write the files of a model on which speed is
measured.

A model is a solid block or plate of steel with round holes, free in space, of
8-node bricks with consistent mass (units kg m s). Its interface is sixteen
grids, 48 dofs, in four patches on its lower side. FOLDER gets

    NAME.op4                K and M, binary OUTPUT4     for ritz-import
    NAME.bdf, NAME.dofs     grids; names of rows
    NAME.port               numbers of the interface grids
    NAME.K.petsc, .M.petsc  matrices of the interior    for the peers
    NAME.npz                K, M, interface dofs        for the harness
    NAME.inp                mesh and material           for CalculiX
    NAME.json               sizes
"""
import dataclasses
import itertools
import json
import pathlib
import sys

import numpy
import scipy.sparse

import output4

E, NU, RHO = 210e9, 0.3, 7850.0

# bricks along x, y, z; edges in metres; every model has two holes
SHAPES = {
    "S10": ((29, 15, 7), (0.8, 0.4, 0.2)),
    "P50": ((107, 75, 1), (1.0, 0.7, 0.006)),
    "S50": ((51, 26, 13), (0.8, 0.4, 0.2)),
    "P150": ((187, 131, 1), (1.0, 0.7, 0.006)),
    "S150": ((75, 38, 19), (0.8, 0.4, 0.2)),
    "S400": ((105, 53, 26), (0.8, 0.4, 0.2)),
    "S1000": ((143, 72, 35), (0.8, 0.4, 0.2)),
}
HOLES, RADIUS = 2, 0.18  # radius as a part of the width

# corners of a brick in the order of VTK and CalculiX
CORNERS = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0],
                       [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
ELEMENTS_AT_ONCE = 60000  # entries of so many are held while they are summed


@dataclasses.dataclass
class Model:
    """K and M have both triangles; port has the rows of the interface dofs, and
    position a row for each grid."""

    K: scipy.sparse.csc_matrix
    M: scipy.sparse.csc_matrix
    position: numpy.ndarray
    bricks: numpy.ndarray
    port: numpy.ndarray

    @property
    def interior(self):
        return numpy.setdiff1d(numpy.arange(self.K.shape[0]), self.port)


def element(edges):
    """Stiffness and mass of a brick, 24 x 24, by 2 x 2 x 2 Gauss points."""
    sign = 2.0 * CORNERS - 1.0
    lame, shear = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
    C = numpy.diag([2 * shear] * 3 + [shear] * 3)
    C[:3, :3] += lame
    K, M = numpy.zeros((24, 24)), numpy.zeros((24, 24))
    weight = numpy.prod(edges) / 8
    for point in itertools.product((-3**-0.5, 3**-0.5), repeat=3):
        factor = 1 + sign * point
        N = factor.prod(axis=1) / 8
        B = numpy.zeros((6, 24))
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            dN = sign[:, a] * factor[:, b] * factor[:, c] / (4 * edges[a])
            B[a, a::3] = dN
            B[3 + a, b::3] = dN        # shear of the plane a, b
            B[3 + c, c::3] = dN        # and of the plane c, a
        K += weight * B.T @ C @ B
        M += weight * RHO * numpy.kron(numpy.outer(N, N), numpy.eye(3))
    return (K + K.T) / 2, (M + M.T) / 2


def assemble(bricks, matrix, n):
    """Assemble one matrix from all bricks; zeros of the element are left
    out."""
    rows, columns = numpy.nonzero(numpy.tril(matrix) != 0)
    # the lower triangle of the sum has entries of both triangles of a brick
    rows, columns = (numpy.r_[rows, columns[rows != columns]],
                     numpy.r_[columns, rows[rows != columns]])
    dofs = (3 * bricks[:, :, None] + numpy.arange(3)).reshape(-1, 24)
    dofs = dofs.astype(numpy.int32)
    total = scipy.sparse.csc_matrix((n, n))
    for first in range(0, len(dofs), ELEMENTS_AT_ONCE):
        part = dofs[first:first + ELEMENTS_AT_ONCE]
        i, j = part[:, rows].ravel(), part[:, columns].ravel()
        values = numpy.tile(matrix[rows, columns], len(part))
        lower = i >= j
        total = total + scipy.sparse.coo_matrix(
            (values[lower], (i[lower], j[lower])), (n, n)).tocsc()
    total = total + scipy.sparse.tril(total, -1).T
    total.eliminate_zeros()
    total.sort_indices()
    return total


def make(counts, lengths, holes=HOLES):
    counts, lengths = numpy.array(counts), numpy.array(lengths)
    edges = lengths / counts
    cell = numpy.argwhere(numpy.ones(counts))
    centre = (cell[:, :2] + 0.5) * edges[:2]
    for k in range(1, holes + 1):
        axis = lengths[:2] * (k / (holes + 1), 0.5)
        outside = (((centre - axis)**2).sum(axis=1)
                   > (RADIUS * lengths[1])**2)
        cell, centre = cell[outside], centre[outside]
    at = cell[:, None, :] + CORNERS  # brick, corner, axis
    size = counts + 1
    node = (at[..., 0] * size[1] + at[..., 1]) * size[2] + at[..., 2]
    used, bricks = numpy.unique(node, return_inverse=True)
    bricks = bricks.reshape(node.shape)
    place = numpy.stack(numpy.unravel_index(used, size), axis=1)
    patch = [[1, 2, n - 2, n - 1] for n in counts[:2]]
    grids = numpy.flatnonzero(numpy.isin(place[:, 0], patch[0])
                              & numpy.isin(place[:, 1], patch[1])
                              & (place[:, 2] == 0))
    K, M = element(edges)
    n = 3 * len(used)
    return Model(assemble(bricks, K, n), assemble(bricks, M, n), place * edges,
                 bricks, (3 * grids[:, None] + numpy.arange(3)).ravel())


def write_petsc(A, path):
    """Write a sparse matrix as PETSc's MatLoad reads it, big-endian."""
    A = A.tocsr()
    A.sort_indices()
    with open(path, "wb") as file:
        for numbers in ([1211216, *A.shape, A.nnz], numpy.diff(A.indptr),
                        A.indices):
            numpy.asarray(numbers, ">i4").tofile(file)
        A.data.astype(">f8").tofile(file)


def write_grids(model, stem):
    with open(stem.with_suffix(".bdf"), "w", encoding="ascii") as deck:
        deck.write("BEGIN BULK\n")
        deck.writelines(f"GRID,{k},,{x:.12g},{y:.12g},{z:.12g}\n"
                        for k, (x, y, z) in enumerate(model.position, 1))
        deck.write("ENDDATA\n")
    with open(stem.with_suffix(".dofs"), "w", encoding="ascii") as table:
        table.writelines(f"{k} 1\n{k} 2\n{k} 3\n"
                         for k in range(1, len(model.position) + 1))
    grids = sorted(set(model.port // 3 + 1))
    stem.with_suffix(".port").write_text(",".join(map(str, grids)))


def write_calculix(model, path):
    """Write the mesh; peer_calculix.sh adds steps and reads it by *INCLUDE."""
    with open(path, "w", encoding="ascii") as deck:
        deck.write("*NODE,NSET=NALL\n")
        deck.writelines(f"{k},{x:.12g},{y:.12g},{z:.12g}\n"
                        for k, (x, y, z) in enumerate(model.position, 1))
        deck.write("*ELEMENT,TYPE=C3D8,ELSET=EALL\n")
        deck.writelines(f"{k}," + ",".join(map(str, brick + 1)) + "\n"
                        for k, brick in enumerate(model.bricks, 1))
        deck.write("*NSET,NSET=PORT\n")
        deck.writelines(f"{g},\n" for g in sorted(set(model.port // 3 + 1)))
        deck.write(f"*MATERIAL,NAME=STEEL\n*ELASTIC\n{E},{NU}\n"
                   f"*DENSITY\n{RHO}\n"
                   "*SOLID SECTION,ELSET=EALL,MATERIAL=STEEL\n")


def write(name, folder):
    model = make(*SHAPES[name])
    stem = pathlib.Path(folder) / name
    inside = model.interior
    output4.write(stem.with_suffix(".op4"), K=model.K, M=model.M)
    write_grids(model, stem)
    write_calculix(model, stem.with_suffix(".inp"))
    for letter, A in ("K", model.K), ("M", model.M):
        write_petsc(A[inside][:, inside],
                    stem.with_suffix(f".{letter}.petsc"))
    numpy.savez(stem.with_suffix(".npz"), port=model.port,
                position=model.position, shape=model.K.shape,
                **{f"{letter}_{part}": getattr(A, part)
                   for letter, A in (("K", model.K), ("M", model.M))
                   for part in ("data", "indices", "indptr")})
    stem.with_suffix(".json").write_text(json.dumps({
        "dofs": model.K.shape[0], "interior": len(inside),
        "port": len(model.port),
        "entries_K": model.K.nnz, "entries_M": model.M.nnz,
        "bricks": len(model.bricks)}))


def load_port(stem):
    with numpy.load(pathlib.Path(stem).with_suffix(".npz")) as f:
        return f["port"]


def load(stem):
    """Read K, M, the interface dofs and the positions from NAME.npz."""
    with numpy.load(pathlib.Path(stem).with_suffix(".npz")) as f:
        K, M = (scipy.sparse.csc_matrix(
            (f[f"{c}_data"], f[f"{c}_indices"], f[f"{c}_indptr"]), f["shape"])
            for c in "KM")
        return K, M, f["port"], f["position"]


if __name__ == "__main__":
    write(sys.argv[1], sys.argv[2])
