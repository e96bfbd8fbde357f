#!/usr/bin/python3 -s
"""with_exudyn.py PROGRAMS - Exudyn loads what ritz-export writes for it, finds
in it what it would have computed itself, and keeps momentum."""
import sys
import tempfile

import exudyn
import exudyn.FEM
import h5py
import numpy
import scipy.linalg
import scipy.sparse

from common import DATA, Block, Tap, Tools

# both sides sum up to 9 n^2 products, n = 135: their rounding errors, about
# sqrt(9 n^2) eps = 9e-14 of the largest entry; Exudyn also sets what is below
# 1e-13 of the largest to zero
ALLOWED = 1e-12
EPS = numpy.finfo(float).eps


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def load(path):
    body = exudyn.FEM.ObjectFFRFreducedOrderInterface()
    body.LoadFromFile(path)
    return body


def save_own(block, Psi, path):
    """The file that Exudyn saves of the same body and modes."""
    fem = exudyn.FEM.FEMinterface()
    fem.nodes = {"Position": block.position}
    fem.massMatrix = scipy.sparse.csr_matrix(block.M)
    fem.stiffnessMatrix = scipy.sparse.csr_matrix(block.K)
    fem.modeBasis = {"matrix": Psi, "type": "NormalModes"}
    fem.surface = []
    exudyn.FEM.ObjectFFRFreducedOrderInterface(fem).SaveToFile(path)


def compare_files(tap, title, ours, own):
    with h5py.File(ours) as a, h5py.File(own) as b:
        tap.check(set(a) == set(b), f"{title}: the members are Exudyn's",
                  " ".join(sorted(set(a) ^ set(b))))
        for name in sorted(set(a) & set(b)):
            x, y = a[name], b[name]
            tap.check(x.attrs["datatype"] == y.attrs["datatype"],
                      f"{title}: {name} is said to be of the same type",
                      y.attrs["datatype"])
            if isinstance(y, h5py.Group):
                tap.check(len(x) == len(y) == 0, f"{title}: {name} is empty")
            elif y.dtype.kind == "O":
                tap.check(text(x[()]) == text(y[()]),
                          f"{title}: {name} is the same text", text(y[()]))
            elif y.dtype.kind == "i":
                tap.check(x.dtype == y.dtype and (x[()] == y[()]).all(),
                          f"{title}: {name} is the same", str(y[()]))
            else:
                # what is zero but for rounding is held to what it is made of
                allowed = ALLOWED * zero_scale(name, b)
                tap.check(x.dtype == y.dtype, f"{title}: {name} is of doubles")
                tap.near(x[()], y[()], allowed, f"{title}: {name} agrees")


def zero_scale(name, file):
    """Free modes have no momentum: m psi summed is rounding alone. Relative to
    the largest entry of the sum's terms, not of the sum."""
    weight = {"mPhitTPsi": 1.0, "mPhitTPsiTilde": 1.0,
              "mXRefTildePsi": 2.0, "mXRefTildePsiTilde": 2.0}.get(name)
    if weight is None:
        return 1.0
    terms = file["totalMass"][()] * numpy.abs(file["modeBasis"][()]).max()
    if weight == 2.0:
        terms *= numpy.abs(file["xRef"][()]).max()
    found = numpy.abs(file[name][()]).max()
    return max(1.0, terms / max(found, 1e-300))


def simulate(body, seconds, step, spin):
    """States (position, quaternion, modes) and rates in a free flight, before
    every step; modes are given a push too."""
    system = exudyn.SystemContainer()
    mbs = system.AddSystem()
    body.AddObjectFFRFreducedOrder(mbs, initialVelocity=[0.3, -0.2, 0.1],
                                   initialAngularVelocity=spin)
    mbs.Assemble()
    rates = numpy.array(mbs.systemData.GetODE2Coordinates_t())
    rates[7] = 0.1 / numpy.abs(body.modeBasis[:, 0]).max()
    mbs.systemData.SetODE2Coordinates_t(
        rates, exudyn.ConfigurationType.Initial)
    states = []
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime = seconds
    settings.timeIntegration.numberOfSteps = round(seconds / step)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.relativeTolerance = 1e-11
    settings.timeIntegration.newton.absoluteTolerance = 1e-11
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.show.computationTime = False

    def keep(*_):
        get = mbs.systemData
        states.append((numpy.array(get.GetODE2Coordinates()),
                       numpy.array(get.GetODE2Coordinates_t())))
        return True

    mbs.SetPreStepUserFunction(lambda mbs, t: keep())
    mbs.SolveDynamic(settings)
    keep()
    return states


def motion(state):
    """Place, rotation, body angular velocity, velocity, modes, their rates."""
    q, rate = state
    e = q[3:7] + [1, 0, 0, 0]
    w, x, y, z = e
    A = numpy.array(
        [[w*w + x*x - y*y - z*z, 2*(x*y - w*z), 2*(x*z + w*y)],
         [2*(x*y + w*z), w*w - x*x + y*y - z*z, 2*(y*z - w*x)],
         [2*(x*z - w*y), 2*(y*z + w*x), w*w - x*x - y*y + z*z]])
    G = 2.0 * numpy.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
    return q[:3], A, G @ rate[3:7], rate[:3], q[7:], rate[7:]


def momenta_of_nodes(block, Psi, state):
    """Linear and angular momentum about the origin, from nodes and M alone."""
    place, A, omega, velocity, q, rate = motion(state)
    X = block.position + (Psi @ q).reshape(-1, 3)
    x = place + X @ A.T
    v = velocity + (numpy.cross(omega, X) + (Psi @ rate).reshape(-1, 3)) @ A.T
    p = (block.M @ v.ravel()).reshape(-1, 3)
    return numpy.concatenate([p.sum(axis=0), numpy.cross(x, p).sum(axis=0)])


def momenta_of_terms(body, state):
    """The same from the file's terms, which count rotations too."""
    place, A, omega, velocity, q, rate = motion(state)
    Q = numpy.kron(q.reshape(-1, 1), numpy.eye(3))
    S = body.totalMass * body.chiU + body.mPhitTPsi @ q
    first = body.mXRefTildePsiTilde @ Q
    inertia = body.inertiaLocal + first + first.T + \
        Q.T @ body.mPsiTildePsiTilde @ Q
    p = body.totalMass * velocity + A @ (
        numpy.cross(omega, S) + body.mPhitTPsi @ rate)
    h = inertia @ omega + numpy.cross(S, A.T @ velocity) - (
        body.mXRefTildePsi + Q.T @ body.mPsiTildePsi) @ rate
    return numpy.concatenate([p, A @ h + numpy.cross(place, p)])


def check_flight(tap, title, body, momenta, seconds, step, spin, allowed):
    """`allowed` is measured: the second-order error of the integrator, which
    falls to a quarter with half the step, and that is checked too."""
    states = simulate(body, seconds, step, spin)
    errors = []
    for states in states, simulate(body, seconds, step / 2, spin):
        few = states[::len(states) // 100]
        rows = numpy.array([momenta(state) for state in few])
        for part in slice(0, 3), slice(3, 6):
            drift = numpy.abs(rows[1:, part] - rows[0, part]).max()
            errors.append(drift / numpy.linalg.norm(rows[0, part]))
    bent = numpy.abs(body.modeBasis @ states[-1][0][7:]).max()
    tap.check(bent > 1e-4, f"{title}: the body bends in flight",
              f"{bent:.1e} m")
    for k, name in enumerate(["linear", "angular"]):
        tap.check(errors[k] <= allowed,
                  f"{title}: {name} momentum is kept",
                  f"{errors[k]:.1e} <= {allowed:.1e}, "
                  f"{errors[k + 2]:.1e} with half the step")
        tap.check(errors[k + 2] <= max(0.35 * errors[k], 1e-9),
                  f"{title}: what is lost of {name} momentum is the "
                  "integrator's")


def check_block(tap, tools, method, **options):
    title = f"block, {', '.join([method, *options])}"
    block = Block((4, 2, 2), **options)
    rigid = 0 if "clamped" in options else 6
    block.write(tools)
    tools("ritz-basis", method, "--modes", 6, "block.h5", "-o", "basis.h5")
    tools("ritz-reduce", "block.h5", "basis.h5", "-o", "reduced.h5")
    said = tools("ritz-export", "--to", "exudyn", "reduced.h5",
                 "-o", "block.hdf5")
    tap.check(f"{rigid} rigid" in said,
              f"{title}: rigid motions are left out")
    tap.check("rotations" not in said and "approximate" not in said,
              f"{title}: nothing is lost of a solid")
    with h5py.File(tools.path("reduced.h5")) as f:
        T = block.to_basic @ f["T"][:]
        kind = [text(k) for k in f["columns/kind"][:]]
        K_r, M_r = f["K"][:], f["M"][:]
    body = load(tools.path("block.hdf5"))
    Psi = body.modeBasis
    if method == "macneal-rubin":
        flexible = T[:, [k != "rigid" for k in kind]]
        # three products of entries up to 1 and one rounding of each axis
        tap.near(Psi, flexible, 8 * EPS,
                 f"{title}: the modes are the basis' flexible columns")
    else:
        expected = scipy.linalg.eigh(K_r, M_r, eigvals_only=True)[rigid:]
        found = numpy.diag(body.stiffnessMatrixReduced)
        # eps times the condition of M_r, 1e3, and the largest eigenvalue
        tap.near(found, expected, 1e-11,
                 f"{title}: the modes are eigenvectors of the reduced body")
    tap.check(numpy.linalg.matrix_rank(numpy.hstack([Psi, T]))
              == T.shape[1], f"{title}: the modes lie in the basis")
    save_own(block, Psi, tools.path("own.hdf5"))
    compare_files(tap, title, tools.path("block.hdf5"),
                  tools.path("own.hdf5"))
    return block, body


def check_rotor(tap, tools, method):
    title = f"rotor, {method}"
    source = DATA / "dualspin"
    tools("ritz-import", "--stiffness", f"{source / 'rotor.op4'}:KGG",
          "--mass", f"{source / 'rotor.op4'}:MGG",
          "--bulk", source / "rotor.bdf", "--port", "bearing=1",
          "-o", "rotor.h5")
    tools("ritz-basis", method, "--modes", 8, "rotor.h5", "-o", "basis.h5")
    tools("ritz-reduce", "rotor.h5", "basis.h5", "-o", "reduced.h5")
    said = tools("ritz-export", "--to", "exudyn", "reduced.h5",
                 "-o", "rotor.hdf5")
    tap.check("rotations of 40 grids left out" in said
              and "approximate" not in said,
              f"{title}: rotations are left out of shapes, and of nothing else")
    body = load(tools.path("rotor.hdf5"))
    with h5py.File(tools.path("reduced.h5")) as f:
        expected = scipy.linalg.eigh(f["K"][:], f["M"][:],
                                     eigvals_only=True)[6:]
    found = scipy.linalg.eigh(body.stiffnessMatrixReduced,
                              body.massMatrixReduced, eigvals_only=True)
    # eps times the largest eigenvalue, 5e5, over the smallest, 1.6, tenfold
    tap.check(numpy.allclose(found, expected, rtol=1e-9, atol=0),
              f"{title}: frequencies are those of the reduced body")
    check_flight(tap, title, body, lambda s: momenta_of_terms(body, s),
                 2.0, 1e-3, [0.1, 0.05, 0.5], ROTOR_DRIFT)


def fly(tap, title, block, body):
    check_flight(tap, title, body,
                 lambda s: momenta_of_nodes(block, body.modeBasis, s),
                 1.0, 5e-4, [0.5, 3.0, 4.0], BLOCK_DRIFT)


# measured: 6.6e-6 and 1.0e-8
BLOCK_DRIFT = 2e-5
ROTOR_DRIFT = 1e-7


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        for method in "macneal-rubin", "craig-bampton":
            for options in {}, {"turned": True}:
                block, body = check_block(tap, tools, method, **options)
            fly(tap, f"block, {method}", block, body)
            check_rotor(tap, tools, method)
        # held modes have momentum: no term is zero
        for options in {"clamped": True}, {"clamped": True, "turned": True}:
            block, body = check_block(tap, tools, "craig-bampton", **options)
        fly(tap, "block, clamped", block, body)
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
