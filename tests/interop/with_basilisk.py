#!/usr/bin/python3 -s
"""with_basilisk.py PROGRAMS - a hub with a boom flies in Basilisk: its free
vibrations have the frequencies of the reduced component."""
import importlib.util
import sys
import tempfile

import h5py
import numpy
import scipy.io
import scipy.linalg
import scipy.optimize
import scipy.sparse
from Basilisk.simulation import spacecraft, svIntegrators
from Basilisk.utilities import SimulationBaseClass, macros

from beam import AREA, RHO, beam
from common import Tap, Tools

LENGTH, CELLS, MODES = 5.0, 8, 8
HUB_MASS, HUB_INERTIA = 300.0, (150.0, 250.0, 300.0)


def make_component(tools):
    for name, A in zip("KM", beam(LENGTH, CELLS, HUB_MASS, HUB_INERTIA)):
        scipy.io.mmwrite(tools.path(name + ".mtx"),
                         scipy.sparse.coo_matrix(A), precision=17,
                         symmetry="symmetric")
    with open(tools.path("boom.bdf"), "w") as deck:
        deck.writelines(f"GRID,{k + 1},,{LENGTH * k / CELLS!r},0.,0.\n"
                        for k in range(CELLS + 1))
    tools("ritz-import", "--stiffness", "K.mtx", "--mass", "M.mtx", "--bulk",
          "boom.bdf", "--port", "hub=1", "--units", "kg m s", "-o", "boom.h5")
    tools("ritz-basis", "craig-bampton", "--modes", MODES, "boom.h5", "-o",
          "basis.h5")
    tools("ritz-reduce", "boom.h5", "basis.h5", "-o", "small.h5")
    return tools("ritz-export", "--to", "basilisk", "small.h5", "-o",
                 "boom.py")


def load(path):
    spec = importlib.util.spec_from_file_location("boom", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def fly(module, step, seconds):
    """Histories of all effectors that begin out of rest."""
    sim = SimulationBaseClass.SimBaseClass()
    process = sim.CreateNewProcess("all")
    process.addTask(sim.CreateNewTask("flight", macros.sec2nano(step)))
    craft = spacecraft.Spacecraft()
    craft.setIntegrator(svIntegrators.svIntegratorRK4(craft))
    effectors = module.attach(craft)
    for k, e in enumerate(effectors):
        if hasattr(e, "rhoInit"):
            e.rhoInit = 1e-6 * (1.0 + 0.1 * k)
        else:
            e.thetaInit = 1e-6
        e.ModelTag = f"effector{k}"
        sim.AddModelToTask("flight", e)
    sim.AddModelToTask("flight", craft)
    sim.InitializeSimulation()
    names = [e.nameOfRhoState if hasattr(e, "rhoInit") else e.nameOfThetaState
             for e in effectors]
    states = [craft.dynManager.getStateObject(name) for name in names]
    rows = []
    for k in range(int(round(seconds / step)) + 1):
        rows.append([numpy.ravel(s.getState())[0] for s in states])
        sim.ConfigureStopTime(macros.sec2nano((k + 1) * step))
        sim.ExecuteSimulation()
    return numpy.arange(len(rows)) * step, numpy.array(rows)


def fit(time, rows, hertz):
    """Frequencies of a sum of oscillations in all rows, from a first guess;
    a constant and a drift are there too."""
    scale = numpy.abs(rows).max(axis=0)

    def terms(f):
        w = 2.0 * numpy.pi * f
        return numpy.hstack([numpy.cos(numpy.outer(time, w)),
                             numpy.sin(numpy.outer(time, w)),
                             numpy.vander(time, 2)])

    def rest(f):
        A = terms(f)
        return (rows / scale - A @ numpy.linalg.lstsq(A, rows / scale,
                                                      rcond=None)[0]).ravel()

    done = scipy.optimize.least_squares(rest, hertz, x_scale=hertz * 1e-6,
                                        xtol=1e-15, ftol=1e-15, gtol=1e-15)
    return done.x, numpy.abs(done.fun).max()


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        tools = Tools(sys.argv[1], folder)
        said = make_component(tools)
        print(said)
        module = load(tools.path("boom.py"))
        with h5py.File(tools.path("small.h5")) as file:
            w2 = scipy.linalg.eigvalsh(file["K"][:], file["M"][:])
        known = numpy.sqrt(w2[6:]) / (2.0 * numpy.pi)
        tap.check(len(module.SPRINGS) + len(module.SPINNERS) == MODES,
                  f"{len(module.SPRINGS)} masses on springs and "
                  f"{len(module.SPINNERS)} bodies that turn stand for all "
                  "modes")
        mass, centre, inertia = module.hub()
        whole = HUB_MASS + RHO * AREA * LENGTH
        total = mass + sum(s["mass"] for s in module.SPRINGS)
        tap.near(total, whole, 1e-13, "masses of hub and effectors add up")
        tap.check(numpy.linalg.eigvalsh(inertia).min() > 0.0,
                  "the hub that is left has a definite inertia")
        # phase errors of RK4 are (w h)^4 / 120; Basilisk counts nanoseconds
        step = round(0.04e9 / (2.0 * numpy.pi * known[-1])) * 1e-9
        time, rows = fly(module, step, 3.0 / known[0])
        found, rest = fit(time, rows, known)
        tap.check(rest < 1e-4, "the motion is a sum of oscillations",
                  f"{rest:.1e}")
        tap.near(found / known, numpy.ones(MODES), 1e-6,
                 "its frequencies are those of the reduced component")
    tap.finish()


main()
