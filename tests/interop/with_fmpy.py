#!/usr/bin/python3 -s
"""with_fmpy.py PROGRAMS - FMPy validates the FMUs of ritz-export and simulates
them both ways, and their motion is that of ritz-simulate."""
import pathlib
import shutil
import sys
import tempfile

import fmpy
import fmpy.fmi2
import fmpy.fmi3
import numpy
from fmpy.validation import validate_fmu

from common import DATA, Tap, Tools

# Co-simulation is exact: rounding alone, of a few hundred steps.
EXACT = 1e-10
# CVode's absolute and relative tolerance, and what its error adds up to; of
# states that are no modes, each of which holds all frequencies, 9e-9 was
# measured of an acceleration, 5e-11 of all else.
TOLERANCE, INTEGRATED, INTEGRATED_STATES = 1e-10, 1e-8, 3e-8


def make_component(tools):
    """The rotor, with a force, a moment, and motions of each order."""
    rotor = DATA / "dualspin" / "rotor"
    tools("ritz-import", "--stiffness", f"{rotor}.op4:KGG",
          "--mass", f"{rotor}.op4:MGG", "--bulk", f"{rotor}.bdf",
          "--port", "bearing=1", "--input", "torque=1:6",
          "--input", "push=55:1", "--output-at", "boom=55:1",
          "--output-at", "rate=55:2/vel", "--output-at", "felt=55:1/acc",
          "--output-at", "turn=1:6", "--units", "kg m s", "-o", "rotor.h5")
    tools("ritz-basis", "macneal-rubin", "--up-to-hz", "5", "--attach",
          "bearing", "rotor.h5", "-o", "basis.h5")
    tools("ritz-reduce", "rotor.h5", "basis.h5", "-o", "reduced.h5")
    tools("ritz-verify", "--band-hz", "0,3", "--damping", "modal 0.01",
          "rotor.h5", "reduced.h5", "-o", "verified.h5")


def make_system(tools):
    """The dual-spin spacecraft at a configuration, and its errors there."""
    folder = pathlib.Path(tools.folder) / "dualspin"
    shutil.copytree(DATA / "dualspin", folder)
    (folder / "build").mkdir(exist_ok=True)
    for body, more in (("rotor", ["--port", "bearing=1"]),
                       ("stator", ["--port", "bearing=1", "--port", "scan=5"]),
                       ("platform", ["--port", "scan=1"])):
        stiffness = [] if body == "platform" else \
            ["--stiffness", f"dualspin/{body}.op4:KGG"]
        tools("ritz-import", *stiffness, "--mass", f"dualspin/{body}.op4:MGG",
              "--bulk", f"dualspin/{body}.bdf", *more, "--units", "kg m s",
              "-o", f"dualspin/build/{body}.h5")
    tools("ritz-assemble", "--at", "clock=60", "dualspin/scene.yaml",
          "-o", "system.h5")
    tools("ritz-assemble", "--full", "--at", "clock=60", "dualspin/scene.yaml",
          "-o", "full.h5")
    tools("ritz-verify", "--at", "clock=60", "full.h5", "system.h5",
          "-o", "verified-system.h5")


def table(tools, path, *arguments):
    """Columns of a time response."""
    tools("ritz-simulate", path, *arguments, "-o", "motion.h5")
    tools("ritz-export", "--to", "tsv", "motion.h5", "-o", "motion.tsv")
    with open(tools.path("motion.tsv")) as file:
        names = file.readline().lstrip("# ").rstrip("\n").split("\t")
        rows = numpy.loadtxt(file, delimiter="\t", ndmin=2)
    return dict(zip(names, rows.T))


class Slave:
    """An instance for co-simulation, of either version."""

    def __init__(self, path):
        self.folder = fmpy.extract(path)
        self.about = fmpy.read_model_description(path)
        two = self.about.fmiVersion == "2.0"
        self.three = not two
        kind = fmpy.fmi2.FMU2Slave if two else fmpy.fmi3.FMU3Slave
        self.fmu = kind(
            guid=self.about.guid, instanceName="one",
            unzipDirectory=self.folder,
            modelIdentifier=self.about.coSimulation.modelIdentifier)
        self.fmu.instantiate()
        self.reference = {v.name: v.valueReference
                          for v in self.about.modelVariables}

    def start(self):
        if not self.three:
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def put(self, name, value):
        to = [self.reference[name]], [value]
        self.fmu.setFloat64(*to) if self.three else self.fmu.setReal(*to)

    def get(self, names):
        of = [self.reference[name] for name in names]
        return self.fmu.getFloat64(of) if self.three else self.fmu.getReal(of)

    def step(self, time, size):
        self.fmu.doStep(currentCommunicationPoint=time,
                        communicationStepSize=size)

    def end(self):
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder)


def columns(rows, names):
    return numpy.array([rows[name] for name in names]).T


def march(slave, times, inputs, outputs):
    """Outputs at times, each input held from one to the next."""
    found = []
    for k, time in enumerate(times):
        for name, values in inputs.items():
            slave.put(name, float(values[k]))
        found.append(slave.get(outputs))
        if k + 1 < len(times):
            slave.step(time, times[k + 1] - time)
    return numpy.array(found)


def near_each(tap, found, expected, allowed, sentence):
    """Relative to the largest value of each column."""
    scale = numpy.abs(expected).max(axis=0)
    error = (numpy.abs(found - expected).max(axis=0) / scale).max()
    tap.check(error <= allowed, sentence, f"{error:.1e} <= {allowed:.0e}")


def check_held(tap, tools, title, model, fmu):
    """Co-simulation is ritz-simulate --hold zero."""
    signals = {name: f"sine:{0.3 + 0.2 * k}*{1 + k}"
               for k, name in enumerate(model["inputs"])}
    words = [word for name, signal in signals.items()
             for word in ("--input", f"{name}={signal}")]
    rows = table(tools, model["file"], *model["options"], *words, "--hold",
                 "zero", "--step", "0.05", "--seconds", "20")
    slave = Slave(fmu)
    slave.start()
    names = list(model["outputs"])
    inputs = {name: rows[name] for name in model["inputs"]}
    found = march(slave, rows["seconds"], inputs, names)
    near_each(tap, found, columns(rows, names), EXACT,
              f"{title}: co-simulation with held inputs is --hold zero")
    slave.end()


def check_states_saved(tap, title, model, fmu):
    """A state that was saved, serialised and restored goes on the same way."""
    slave = Slave(fmu)
    slave.start()
    names = list(model["outputs"])
    push = {name: numpy.ones(9) for name in model["inputs"]}
    march(slave, numpy.linspace(0, 1, 9), push, names)
    f = slave.fmu
    get, put = (f.getFMUState, f.setFMUState) if slave.three else \
        (f.getFMUstate, f.setFMUstate)
    saved = get()
    data = f.serializeFMUState(saved) if slave.three else \
        f.serializeFMUstate(saved)
    times = 1 + numpy.linspace(0, 1, 9)
    once = march(slave, times, push, names)
    put(f.deserializeFMUState(data) if slave.three
        else f.deSerializeFMUstate(data))
    again = march(slave, times, push, names)
    tap.check((once == again).all(),
              f"{title}: a state that was serialised goes on bitwise")
    slave.end()


def check_exchange(tap, tools, title, model, fmu):
    """FMPy's own loops give the same, for constant inputs."""
    words = [word for name in model["inputs"]
             for word in ("--input", f"{name}=step")]
    rows = table(tools, model["file"], *model["options"], *words,
                 "--step", "0.1", "--seconds", "4")
    names = list(model["outputs"])
    expected = columns(rows, names)
    for kind, allowed in (("CoSimulation", EXACT),
                          ("ModelExchange", model["integrated"])):
        result = fmpy.simulate_fmu(
            fmu, fmi_type=kind, stop_time=4.0, output_interval=0.002,
            solver="CVode", relative_tolerance=TOLERANCE, output=names,
            start_values={name: 1.0 for name in model["inputs"]})
        at = numpy.searchsorted(result["time"], rows["seconds"] - 1e-6)
        near_each(tap, columns(result, names)[at], expected, allowed,
                  f"{title}: FMPy's {kind} is ritz-simulate")


def main():
    with tempfile.TemporaryDirectory() as folder:
        tools, tap = Tools(sys.argv[1], folder), Tap()
        make_component(tools)
        make_system(tools)
        tools("ritz-export", "--to", "container", "--states", "--damping",
              "modal 0.01", "verified.h5", "-o", "states.h5")
        rotor = {"inputs": ["torque", "push"],
                 "outputs": ["boom", "rate", "felt", "turn"]}
        models = {
            "component": dict(rotor, file="verified.h5",
                              options=["--damping", "modal 0.01"],
                              integrated=INTEGRATED),
            "states": dict(rotor, file="states.h5", options=[],
                           integrated=INTEGRATED_STATES),
            "system": {"inputs": ["torque_rotor"], "outputs": ["gyro"],
                       "file": "verified-system.h5",
                       "options": ["--at", "clock=60"],
                       "integrated": INTEGRATED},
        }
        for name, model in models.items():
            for version in "2", "3":
                fmu = tools.path(f"{name}-{version}.fmu")
                title = f"FMI {version}, {name}"
                tools("ritz-export", "--to", "fmu", "--fmi", version,
                      *model["options"], model["file"], "-o", fmu)
                problems = validate_fmu(fmu)
                tap.check(not problems, f"{title}: FMPy finds it valid",
                          "; ".join(problems))
                check_held(tap, tools, title, model, fmu)
                check_states_saved(tap, title, model, fmu)
                check_exchange(tap, tools, title, model, fmu)
        tap.finish()


if __name__ == "__main__":
    main()
