#!/usr/bin/python3 -s
"""ratios.py FOLDER-OF-THE-TOOLS [--only SET] - damping `modal Z` with Z from
0.001 to 0.9, on components of data/ and on third-party ones. Prints the table
of docs/methods/damping.md.

The reference is D = 2 Z M (M^-1 K)^1/2, as the sum of all modes by SciPy. The
script compares with it the engines of ritz-frf and, by ritz-reduce and
ritz-verify, an identity basis and Craig-Bampton with its bound. It also measures
how well the matrices define the reference: how far the sum moves when each entry
of K and M changes by up to one unit of its last digit. That matters for free
bodies, whose rigid stiffness is rounding.

Status 1 if
- an engine is off by more than that plus 1e-10 of the largest |H|, krylov and
  rational plus 1e-9; above 2000 dofs plus 1e-6;
- an identity basis is off by more than 1e-10, or 1e-9 at Z = 0.001, where a
  resonance amplifies the rounding of its eigenvalue 500 times;
- a bound is below what ritz-verify measures.

Third-party files are read from RITZ_EXTERNAL_DATA.
"""
import pathlib
import sys

import h5py
import numpy
import scipy.linalg

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import effectivity  # noqa: E402
import methods  # noqa: E402

RATIOS = [0.001, 0.1, 0.9]
ENGINES = {"modal": 1e-10, "direct": 1e-10, "krylov": 1e-9, "rational": 1e-9}
LARGE = 2000  # dofs; larger sets do not find all modes
LARGE_WITHIN = 1e-6
IDENTITY = 1e-10
DENSE = 2000  # dofs; larger sets have no identity basis
LOW = 0.05  # of the band: on free bodies rounding of K dominates below
POINTS = 31
MOVES = 2  # random changes of the last digits of K and M
LONG = 800  # dofs up to which moved references use long doubles, too


def tetrahedra(external, folder):
    """A free steel solid of linear tetrahedra, on a mesh of ANSYS."""
    p = external / "ansys"

    def table(name, first, last):
        lines = (p / name).read_text(encoding="latin-1").splitlines()[1:]
        return [line.replace(",", ".").split()[first:last]
                for line in lines if line.strip()]
    nodes = table("NodalCoordinatesAnsysTet4Elements.txt", 0, 4)
    row_of = {node[0].rstrip("."): k for k, node in enumerate(nodes)}
    x = numpy.array([[float(v.rstrip(".")) for v in node[1:]]
                     for node in nodes])
    elements = numpy.array([[row_of[v] for v in row] for row in table(
        "ElementConnectivityAnsysTet4Elements.txt", 2, 6)])
    n = 3 * len(x)
    K, M = numpy.zeros((n, n)), numpy.zeros((n, n))
    young, nu, rho = 2.1e11, 0.3, 7800.0
    E = numpy.diag(3 * [1 - nu] + 3 * [0.5 - nu])
    E[:3, :3] += nu * (1 - numpy.eye(3))
    E *= young / (1 + nu) / (1 - 2 * nu)
    for nodes in elements:
        A = numpy.column_stack([numpy.ones(4), x[nodes]])
        volume = abs(numpy.linalg.det(A)) / 6
        g = numpy.linalg.inv(A)[1:]  # gradients of the shape functions
        S = numpy.zeros((6, 12))
        for k in range(4):
            a, b, c = g[:, k]
            S[:, 3 * k:3 * k + 3] = [[a, 0, 0], [0, b, 0], [0, 0, c],
                                     [b, a, 0], [0, c, b], [c, 0, a]]
        rows = numpy.repeat(3 * nodes, 3) + numpy.tile([0, 1, 2], 4)
        K[numpy.ix_(rows, rows)] += volume * S.T @ E @ S
        M[numpy.ix_(rows, rows)] += rho * volume / 20 * numpy.kron(
            numpy.ones((4, 4)) + numpy.eye(4), numpy.eye(3))
    last = len(x)
    face = ",".join(str(1 + k * (last - 1) // 3) for k in range(4))
    return dict(order=40, options=[
        "--stiffness", methods.write(folder, "tet4.k", (K + K.T) / 2),
        "--mass", methods.write(folder, "tet4.m", (M + M.T) / 2), "--dofs",
        methods.rows(folder, "tet4", last, "123"), "--port",
        f"face={face}:123", "--input", f"in={last // 3}:1", "--output-at",
        f"out={last // 2}:1"])


def linear_block(external, folder, _):
    """A free solid of linear tetrahedra with lumped masses."""
    p = external / "abaqus"
    K, M = (methods.abaqus(p / f"blockC3D4_{name}1.mtx")
            for name in ("STIF", "MASS"))
    n = K.shape[0] // 3
    return dict(order=40, options=[
        "--stiffness", methods.write(folder, "block.k", K), "--mass",
        methods.write(folder, "block.m", M), "--dofs",
        methods.rows(folder, "block", n, "123"), "--port", "face=1,2,3,4:123",
        "--input", f"in={n}:1", "--output-at", f"out={n // 2}:1"])


def conrod(external, folder, _):
    """A free connecting rod of quadratic tetrahedra."""
    p = external / "calculix/conrod"
    dofs = [line.split(".") for line in
            (p / "conrod.dof").read_text().split()]
    options = []
    for name, end in (("stiffness", "sti"), ("mass", "mas")):
        t = numpy.loadtxt(p / f"conrod.{end}")
        A = methods.scipy.sparse.coo_matrix(
            (t[:, 2], (t[:, 0].astype(int) - 1, t[:, 1].astype(int) - 1)))
        A = A + A.T - methods.scipy.sparse.diags(A.diagonal())
        options += [f"--{name}", methods.write(folder, f"conrod.{end}", A)]
    names = folder / "conrod.dofs"
    names.write_text("".join(f"{g} {c}\n" for g, c in dofs))
    grids = list(dict.fromkeys(g for g, _ in dofs))
    return dict(order=40, options=[
        *options, "--dofs", names, "--port",
        f"end={','.join(grids[:4])}:123", "--input", f"in={grids[-1]}:1",
        "--output-at", f"out={grids[len(grids) // 2]}:1"])


def bare_lf10(external, folder, n):
    """The beam LF10 without its damping matrix."""
    case = methods.lf10(external, folder, n)
    at = case["options"].index("--damping")
    del case["options"][at:at + 2], case["damping"]
    return case


SETS = [row if row[0] != "LF10" else (row[0], bare_lf10, row[2])
        for row in methods.SETS] + [
    ("blockC3D4", linear_block, "abaqus/blockC3D4_STIF1.mtx"),
    ("Tet4 mesh", lambda external, folder, _: tetrahedra(external, folder),
     "ansys/NodalCoordinatesAnsysTet4Elements.txt"),
    ("conrod", conrod, "calculix/conrod/conrod.sti"),
]


def moved(rng):
    """A function that changes entries of a symmetric matrix in the last digit."""

    def move(A):
        S = numpy.triu(rng.uniform(-1, 1, A.shape))
        return A * (1 + numpy.finfo(float).eps * (S + numpy.triu(S, 1).T))
    return move


class Large:
    """All modes of a large component, in double precision, from K + soft M."""

    def __init__(self, path, soft, alter):
        with h5py.File(path) as file:
            K, M = (effectivity.sparse(file[key]).toarray() for key in "KM")
            self.B, self.C = file["inputs/B"][()], [file["outputs/C"][()]]
        K, M = (alter((A + A.T) / 2) for A in (K, M))
        kappa, X = scipy.linalg.eigh(M, K + soft * M, overwrite_a=True,
                                     overwrite_b=True)
        X, kappa = X[:, ::-1], kappa[::-1]
        self.value, self.X = 1 / kappa - soft, X / numpy.sqrt(kappa)


class Reference:
    """The sum of all modes of a component."""

    def __init__(self, case, alter=effectivity.exactly):
        path, rigid = case["component"], case["rigid"]
        self.band = case["band"]
        self.low = (LOW if rigid else 0.001) * self.band
        most = LARGE if alter is effectivity.exactly else LONG
        full = effectivity.Full(path, rigid, alter) if case["dofs"] <= most \
            else Large(path, (2 * numpy.pi * self.band / 3)**2, alter)
        self.value = full.value.copy()
        self.value[:rigid] = 0
        self.B, self.C = full.X.T @ full.B, full.C[0] @ full.X

    def largest(self, ratio):
        """The largest |H| of the band, resonances included."""
        hertz = numpy.concatenate([numpy.linspace(self.low, self.band, 500),
                                   numpy.sqrt(self.value) / 2 / numpy.pi])
        return abs(self.respond(ratio, hertz[(hertz >= self.low) & (
            hertz <= self.band)])).max()

    def respond(self, ratio, hertz):
        """H at the given frequencies; outputs are displacements."""
        w = 2 * numpy.pi * hertz[:, None]
        own = self.value[None]
        Z = own - w**2 + 2j * ratio * w * numpy.sqrt(own)
        return (self.C[None] / Z[:, None]) @ self.B


def worth_of(case, reference):
    """For each ratio, how far the last digits of K and M move the reference."""
    hertz = numpy.linspace(reference.low, reference.band, POINTS)
    rng = numpy.random.default_rng(3)
    others = [Reference(case, moved(rng)) for _ in range(MOVES)]
    return {ratio: max(abs(other.respond(ratio, hertz)
                           - reference.respond(ratio, hertz)).max()
                       for other in others) / reference.largest(ratio)
            for ratio in RATIOS}


def response_of(path):
    """Frequencies and H from a file of ritz-frf."""
    with h5py.File(path) as file:
        return (file["hertz"][()],
                file["H/real"][()] + 1j * file["H/imag"][()])


def engines_of(bin_, case, reference, ratio):
    """By engine: largest error over the largest |H|, stated uncertainty."""
    out = case["folder"] / "response.h5"
    largest = reference.largest(ratio)
    found = {}
    for engine in ENGINES:
        said = methods.run(
            bin_, "ritz-frf", case["component"], "--method", engine,
            "--from-hz", f"{reference.low:.9g}", "--to-hz", f"{case['band']:.9g}",
            "--points", POINTS, "--no-refine", "--damping", f"modal {ratio}",
            "-o", out)
        hertz, H = response_of(out)
        exact = reference.respond(ratio, hertz)
        found[engine] = (abs(H.reshape(exact.shape) - exact).max()
                         / largest, said.get("ratios_uncertain"))
    return found


def reduction_of(bin_, case, method, more, ratio):
    """Number of columns, error by ritz-verify, and bound by ritz-reduce."""
    folder, component = case["folder"], case["component"]
    basis, reduced = folder / "basis.h5", folder / "reduced.h5"
    damping = ["--damping", f"modal {ratio}"]
    low = LOW * case["band"] if case["rigid"] else 0
    band = ["--band-hz", f"{low:.9g},{case['band']:.9g}"]
    made = methods.run(bin_, "ritz-basis", method, *more, component, "-o",
                       basis)
    methods.run(bin_, "ritz-reduce", component, basis, "-o", reduced, *band,
                *damping)
    told = effectivity.estimates_of(reduced)
    measured = {m["name"]: m["value"] for m in methods.run(
        bin_, "ritz-verify", component, reduced, "-o", folder / "verified.h5",
        *band, *damping)["measures"]}
    bound = told.get("response-relative-bound", (float("nan"),))[0]
    return made["vectors"], measured["response-relative"], bound


def cell(value):
    """A number of the table; empty if there is none."""
    return "" if value is None or numpy.isnan(value) else (
        "none" if numpy.isinf(value) else f"{value:.1e}")


def line(bin_, case, reference, worth, ratio):
    """Print one row of the table; return how many of its numbers are wrong."""
    wrong = []
    found = engines_of(bin_, case, reference, ratio)
    large = case["dofs"] > LARGE
    for engine, within in ENGINES.items():
        error, stated = found[engine]
        if not error <= worth + max(within, LARGE_WITHIN if large else 0):
            wrong.append(f"{engine} is off by {error:.1e}")
        if large and not (stated is not None and error <= max(stated, 1e-9)
                          and stated <= LARGE_WITHIN):
            wrong.append(f"{engine} states {stated} and is off by {error:.1e}")
    cells = [case["name"], str(case["dofs"]), f"{ratio:g}",
             *(cell(found[engine][0]) for engine in ENGINES), cell(worth),
             cell(found["modal"][1])]
    if case["dofs"] <= DENSE:
        _, error, bound = reduction_of(bin_, case, "full", [], ratio)
        if not error <= IDENTITY / min(1, 100 * ratio):
            wrong.append(f"the identity is off by {error:.1e}")
        if error > bound:  # infinite bounds of massless motions pass
            wrong.append(f"identity: {error:.1e} above {bound:.1e}")
        cells += [cell(error), cell(bound)]
    else:
        cells += ["", ""]
    _, error, bound = reduction_of(
        bin_, case, "craig-bampton", ["--modes", case["order"]], ratio)
    if error > bound:
        wrong.append(f"craig-bampton: {error:.1e} above {bound:.1e}")
    print("| " + " | ".join([*cells, cell(error), cell(bound)]) + " |",
          flush=True)
    for what in wrong:
        print(f"{case['name']}, modal {ratio:g}: {what}", file=sys.stderr)
    return len(wrong)


TITLES = ["set", "dofs", "Z", *ENGINES, "digits", "stated", "identity", "bound",
          "craig-bampton", "bound"]


def main():
    """Read the options and print the table."""
    asked = methods.parser_of(__doc__).parse_args()
    methods.SETS[:] = SETS
    print("| " + " | ".join(TITLES) + " |\n|" + "---|" * len(TITLES),
          flush=True)
    wrong = 0
    for case in methods.cases(asked.bin, asked.only):
        reference = Reference(case)
        worth = worth_of(case, reference)
        for ratio in RATIOS:
            wrong += line(asked.bin, case, reference, worth[ratio], ratio)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
