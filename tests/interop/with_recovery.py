#!/usr/bin/python3 -s
"""with_recovery.py PROGRAMS - Exudyn and FMPy simulate the rotor that
ritz-export writes, and ritz-recover brings what they write themselves back onto
the mesh: displacements and stresses are those of the reduced model and, within
the error that ritz-verify states, of the full one."""
import pathlib
import sys
import tempfile

import exudyn
import exudyn.FEM
import exudyn.itemInterface as item
import fmpy
import fmpy.util
import numpy

import recovery
from common import Tap, Tools
from recovery import EVERY, FEED, SECONDS, STIFFNESS_DAMPING, Rotor, error

# N, by which the rotor moves 1e-5 m: squares are 1e-6 of it
PUSH = 1e-2
# Steps, s. The trapezoidal rule makes an oscillation of w rad/s late by
# (w h)^2 / 12 of its phase: of the highest frequency of the force, 2 Hz, at the
# end. Measured: 8.1e-4.
STEPS = 4e-3, 2e-3
HIGHEST = 4.0 * numpy.pi
INTEGRATED = HIGHEST * SECONDS * (HIGHEST * STEPS[0]) ** 2 / 12.0
# What rotations that are not linear leave.
FLOOR = 2e-6
# Rounding of 100 steps. Measured: 2.6e-13.
EXACT = 1e-10


def settings_of(step, folder):
    """Files of a second-order integrator without numerical damping."""
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime = SECONDS
    settings.timeIntegration.numberOfSteps = round(SECONDS / step)
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1
    settings.timeIntegration.generalizedAlpha.useNewmark = True
    settings.timeIntegration.generalizedAlpha.useIndex2Constraints = True
    settings.timeIntegration.newton.relativeTolerance = 1e-12
    settings.timeIntegration.newton.absoluteTolerance = 1e-14
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.name = str(folder / "solution")
    settings.solution.file.writePeriod = EVERY
    settings.solution.sensors.writePeriod = EVERY
    settings.solution.precision = 17
    settings.show.computationTime = False
    return settings


def run_exudyn(rotor, step):
    """modes.txt, of a sensor, and solution.txt."""
    mbs = exudyn.SystemContainer().AddSystem()
    body = exudyn.FEM.ObjectFFRFreducedOrderInterface()
    body.LoadFromFile(rotor.tools.path("rotor.hdf5"))
    made = body.AddObjectFFRFreducedOrder(
        mbs, stiffnessProportionalDamping=STIFFNESS_DAMPING)
    if rotor.held:
        ground = mbs.AddMarker(item.MarkerBodyRigid(
            bodyNumber=mbs.AddObject(item.ObjectGround())))
        frame = mbs.AddMarker(item.MarkerNodeRigid(
            nodeNumber=made["nRigidBody"]))
        mbs.AddObject(item.GenericJoint(markerNumbers=[ground, frame],
                                        constrainedAxes=[1] * 6))
    place = body.xRef.reshape(-1, 3) - rotor.places()[rotor.ids.index(FEED)]
    feed = mbs.AddMarker(item.MarkerSuperElementPosition(
        bodyNumber=made["oFFRFreducedOrder"], weightingFactors=[1.0],
        meshNodeNumbers=[int(numpy.linalg.norm(place, axis=1).argmin())]))
    mbs.AddLoad(item.LoadForceVector(
        markerNumber=feed, loadVector=[rotor.scale, 0.0, 0.0],
        loadVectorUserFunction=lambda mbs, t, load: [
            load[0] * float(recovery.force(t)), 0.0, 0.0]))
    mbs.AddSensor(item.SensorNode(
        nodeNumber=made["nGenericODE2"],
        fileName=rotor.tools.path("modes.txt"),
        outputVariableType=exudyn.OutputVariableType.Coordinates))
    mbs.Assemble()
    mbs.SolveDynamic(settings_of(step, pathlib.Path(rotor.tools.folder)))


def check_exudyn(tap, rotor, *frame):
    """`frame`: options of the frame, for both programs."""
    title = " ".join(["Exudyn,", rotor.name, *frame])
    tools = rotor.tools
    tools("ritz-export", "--force", "--to", "exudyn", *frame,
          f"{rotor.name}.h5", "-o", "rotor.hdf5")
    common = ["--component", f"{rotor.name}.h5", "--transform", "floating",
              *frame]
    own, full = rotor.reduced(), rotor.full()
    errors = []
    for step in STEPS:
        run_exudyn(rotor, step)
        tools("ritz-recover", "modes.txt", *common, "--table", "modes.tsv",
              "-o", "modes.pvd")
        times, *found = rotor.read_pvd("modes.pvd")
        errors.append([error(f, o) for f, o in zip(found, own)])
    tap.near(times, EVERY * numpy.arange(len(own[0])), 1e-12,
             f"{title}: the times are those of the sensor")
    for k, what in enumerate(["displacements", "stresses"]):
        few = f"{errors[0][k]:.1e}, {errors[1][k]:.1e} with half the step"
        tap.check(errors[0][k] <= INTEGRATED,
                  f"{title}: {what} of all grids and bars are those of the "
                  "reduced model", few)
        tap.check(errors[1][k] <= max(0.3 * errors[0][k], FLOOR),
                  f"{title}: the rest is the integrator's, of {what}", few)
    if rotor.held:
        check_full(tap, title, rotor, found, full, errors[1])
    check_maxima(tap, title, rotor, tools.path("modes.tsv"), times, found[1])
    check_solution(tap, title, rotor, common, found)


def check_full(tap, title, rotor, found, full, integrated):
    limits = rotor.stated()
    for k, what in enumerate(["displacements", "stresses"]):
        apart = error(found[k], full[k])
        stated = limits[k] / numpy.abs(full[k]).max()
        tap.check(apart <= stated + integrated[k],
                  f"{title}: {what} are those of the full model within the "
                  "stated error", f"{apart:.1e}, stated {stated:.1e}")


def check_maxima(tap, title, rotor, path, times, stress):
    rows, found = recovery.maxima(path)
    tap.check(rows == rotor.rows, f"{title}: the table names all rows")
    pictured = ~numpy.isnan(stress[0])
    at = numpy.abs(stress).argmax(axis=0)[pictured]
    expected = numpy.column_stack(
        [stress[at, numpy.flatnonzero(pictured)], times[at]])
    # the mesh holds the same doubles
    tap.check((found[pictured] == expected).all(),
              f"{title}: maxima and their times are those of the series",
              f"{pictured.sum()} of {len(rows)} rows are of cells")


def check_solution(tap, title, rotor, common, found):
    """The solution file has the coordinates of the frame in front."""
    tools = rotor.tools
    tools("ritz-recover", "solution.txt", *common, "--to", "xdmf", "-o",
          "solution.xdmf")
    times, *again = rotor.read_xdmf("solution.xdmf",
                                    "modes.frames/000000.vtu")
    count = len(found[0])
    for a, b, what in zip(again, found, ["displacements", "stresses"]):
        pictured = ~numpy.isnan(b[0])
        # both files have the same digits
        tap.near(a[:count][:, pictured], b[:, pictured], 1e-13,
                 f"{title}: the solution file, as XDMF, gives the same {what}")


# --- FMPy ---------------------------------------------------------------------

def run_fmpy(rotor):
    """run.csv of states, derivatives of rates and the force, which is held from
    one output to the next."""
    tools = rotor.tools
    fmu = tools.path("rotor.fmu")
    about = fmpy.read_model_description(fmu)
    names = [v.name for v in about.modelVariables
             if v.name.startswith(("q[", "v[", "der(v["))]
    t = EVERY * numpy.arange(round(SECONDS / EVERY) + 1)
    push = rotor.scale * recovery.force(t)
    numpy.savetxt(tools.path("points.txt"), numpy.c_[t, push], "%.17g")
    result = fmpy.simulate_fmu(
        fmu, fmi_type="CoSimulation", stop_time=SECONDS, output_interval=EVERY,
        output=names + ["push"],
        input=numpy.array(list(zip(t, push)),
                          dtype=[("time", float), ("push", float)]))
    # ritz-recover goes by names, whatever their order is
    fmpy.util.write_csv(tools.path("run.csv"), result,
                        columns=sorted(names) + ["push"])


def check_fmpy(tap, rotor, version):
    title = f"FMPy, FMI {version}, {rotor.name}"
    tools = rotor.tools
    tools("ritz-export", "--force", "--to", "fmu", "--fmi", version,
          *recovery.DAMPED, f"{rotor.name}.h5", "-o", "rotor.fmu")
    run_fmpy(rotor)
    common = ["run.csv", "--component", f"{rotor.name}.h5", "--transform",
              "modes", *recovery.DAMPED]
    tools("ritz-recover", *common, "--modes", "displacement", "--table",
          "run.tsv", "-o", "run.pvd")
    times, *found = rotor.read_pvd("run.pvd", beside=True)
    own = rotor.reduced("points.txt")
    for k, what in enumerate(["displacements", "stresses"]):
        apart = error(found[k], own[k])
        tap.check(apart <= EXACT, f"{title}: {what} are those of "
                  "ritz-simulate --hold zero", f"{apart:.1e}")
    check_maxima(tap, title, rotor, tools.path("run.tsv"), times, found[1])
    if rotor.held:
        check_acceleration(tap, title, rotor, common)


def check_acceleration(tap, title, rotor, common):
    """der(v[k]) and the force are in the file. Where a held force jumps, so do
    they: mode acceleration is no better than modes, no worse than stated."""
    said = rotor.tools("ritz-recover", *common, "-o", "faster.pvd")
    tap.check("by mode acceleration" in said,
              f"{title}: derivatives and the force allow mode acceleration")
    full = rotor.full("points.txt")[1]
    apart = error(rotor.read_pvd("faster.pvd")[2], full)
    stated = rotor.stated()[1] / numpy.abs(full).max()
    tap.check(apart <= stated, f"{title}: stresses by it are those of the full "
              "model within the stated error",
              f"{apart:.1e}, stated {stated:.1e}")


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        held = Rotor(tools, "held", True, PUSH)
        check_exudyn(tap, held)
        for version in "2", "3":
            check_fmpy(tap, held, version)
        free = Rotor(tools, "free", False, PUSH)
        check_exudyn(tap, free, "--frame", str(recovery.HUB), "--reference",
                     "tangent")
        check_fmpy(tap, free, "3")
    tap.finish()


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
