"""Measurements that take more than one process. Each function returns figures
of a model, {name: {value, detail}}, or raises Failed or Unknown with the
reason."""
import pathlib
import shlex
import shutil
import statistics

import h5py
import numpy

import models
import output4
from quality import Unknown
from stopwatch import Failed

HERE = pathlib.Path(__file__).resolve().parent
DUALSPIN = HERE.parents[2] / "data" / "dualspin"

def rayleigh(low, high):
    """a and b of D = a M + b K with 1 % of critical damping at two frequencies
    [Hz]."""
    low, high = 2 * numpy.pi * low, 2 * numpy.pi * high
    return (f"rayleigh {0.02 * low * high / (low + high):.17g} "
            f"{0.02 / (low + high):.17g}")


def channels(shop, model):
    """Import the model with forces and displacements at two opposite
    corners."""
    stem = shop.stem(model)
    path = stem.with_suffix(".channels.h5")
    if not path.exists():
        last = shop.facts[model]["dofs"] // 3
        shop.tool("ritz-import", *shop.import_words(model),
                   "--input", "push=1:3", "--input", f"pull={last}:1",
                   "--output-at", "near=1:1", "--output-at", f"far={last}:3",
                   "-o", path)
    return path


def values(path):
    with h5py.File(path) as f:
        return f["H/real"][:] + 1j * f["H/imag"][:]


FACTORS = 8  # in the difference of two runs that gives the time of one


def response(shop, model):
    """How many times faster ritz-frf computes 1000 points than with a factor at
    each. The time of one factor is (time of 10 points - time of 2 points) / 8,
    every 111th point with a factor of its own: the median of all repeats, 40
    factors in a whole run."""
    component, out = channels(shop, model), shop.out(model)
    common = ["ritz-frf", component, "--damping", rayleigh(1000, 3000),
              "--no-refine", "--from-hz", 10, "--to-hz", 3000]
    each, all_ = [], []
    for _ in range(shop.repeats_of_figures):
        times = {}
        for words in (["--method", "direct", "--points", 2],
                      ["--method", "direct", "--points", 2 + FACTORS],
                      ["--points", 1000]):
            points = words[-1]
            path = out / f"response-{points}.h5"
            times[points] = shop.tool(*common, *words, "-o", path)["wall"]
        each.append((times[2 + FACTORS] - times[2]) / FACTORS)
        all_.append(times[1000])
    factors = FACTORS * len(each)
    each, all_ = statistics.median(each), statistics.median(all_)
    H = values(out / "response-1000.h5")
    exact = values(out / f"response-{2 + FACTORS}.h5")
    error = (numpy.abs(H[::999 // (1 + FACTORS)] - exact)
             / numpy.abs(exact).max(axis=0))
    return {
        "response": {"value": 1000 * each / all_,
                     "detail": f"a factor {each:.3g} s (of {factors}), 1000 "
                               f"points {all_:.3g} s"},
        "response-error": {"value": float(error.max())}}


METHODS = "craig-bampton,macneal-rubin,rubin,krylov,krylov-cms-fixed"


def fit(shop, model):
    """Processor seconds of ritz-fit over those of one Craig-Bampton basis with
    as many columns as the result."""
    component, out = channels(shop, model), shop.out(model)
    cpu = statistics.median(shop.tool(
        "ritz-fit", component, "--methods", METHODS, "--damping", "modal 0.01",
        "--tolerance", "frequency=1e-3,response=1e-2", "--band-hz", "0,1500",
        "-o", out / "fit.h5", limit=shop.limit)["cpu"]
        for _ in range(shop.repeats_of_figures))
    with h5py.File(out / "fit.h5") as f:
        order = f["K"].shape[0]
    modes = max(order - shop.facts[model]["port"], 1)
    basis = statistics.median(
        shop.tool("ritz-basis", "craig-bampton", "--modes", modes, component,
                   "-o", out / "fit-basis.h5")["cpu"]
        for _ in range(shop.repeats_of_figures))
    return {"fit": {"value": cpu / basis,
                    "detail": f"{cpu:.3g} s of processor, {order} columns, a "
                              f"basis {basis:.3g}"}}


SCENE = """scene: two blocks
components:
  a: {{model: {first}, basis: craig-bampton, modes: 30}}
  b: {{model: {second}, basis: craig-bampton, modes: 30}}
joints:
  - {{name: hinge, between: [a/hub, b/hub], type: hinge, axis: [0, 0, 1],
     angles_deg: {angles}}}
inputs:
  - {{name: turn, at: a/hub, component: 6}}
outputs:
  - {{name: angle, at: b/hub, component: 6, quantity: displacement}}
band_hz: [0, 1500]
damping: {{modal: 0.01}}
"""
FEW, MANY = 2, 102  # configurations


def configuration(shop, model):
    """Time that each further configuration adds to COMPARE, over that of stage
    one. The two bodies have the same mesh, but each has a file of its own, and
    another output, so that nothing is computed for both at once."""
    out = shop.out(model)
    bodies = {}
    for body in ("first", "second"):
        bodies[body] = out / f"{body}.h5"
        shop.tool("ritz-import", *shop.import_words(model, port=False),
                   "--output-at", f"{body}=1:1", "--rigid-port",
                   "hub=" + shop.port(model),
                   "-o", bodies[body])
    times = {}
    for count in (FEW, MANY):
        scene = out / f"scene-{count}.yaml"
        angles = [float(a) for a in numpy.linspace(0, 180, count)]
        scene.write_text(SCENE.format(**bodies, angles=angles))
        times[count] = statistics.median(
            shop.tool("ritz-compare", scene, "-o", out / "system.h5")["wall"]
            for _ in range(shop.repeats_of_figures))
    each = (times[MANY] - times[FEW]) / (MANY - FEW)
    first = times[FEW] - FEW * each
    return {"configuration": {
        "value": each / first,
        "detail": f"a configuration {each:.3g} s, stage one {first:.3g} s"}}


READ = """import sys, time
import pyyeti.nastran.op4
began = time.monotonic()
found = pyyeti.nastran.op4.read(sys.argv[1], into="dct", sparse=True)
assert sorted(found) == ["k", "m"] or sorted(found) == ["K", "M"], found
print(time.monotonic() - began)
"""


def import_output4(shop, model):
    """How many times faster the whole ritz-import is than the reading alone of
    pyYeti, without the start of Python."""
    stem, out = shop.stem(model), shop.out(model)
    K, M = models.load(stem)[:2]
    spellings = {"text": output4.write_text, "binary": output4.write}
    python = shop.program("peer-pyyeti")
    figures = {}
    for spelling, write in spellings.items():
        path = out / f"{spelling}.op4"
        write(path, K=K, M=M)
        words = shop.import_words(model, matrices=path)
        ours, theirs = [], []
        for _ in range(shop.repeats_of_figures):
            ours.append(shop.tool("ritz-import", *words, "-o",
                                   out / "imported.h5")["wall"])
            theirs.append(float(shop.peer([*python, "-c", READ, path])["out"]))
        ours, theirs = map(statistics.median, (ours, theirs))
        size = path.stat().st_size / 1e6
        path.unlink()
        figures[f"output4-{spelling}"] = {
            "value": theirs / ours,
            "detail": f"ritz-import {ours:.3g} s, {size / ours:.0f} MB/s; "
                      f"pyYeti {theirs:.3g} s, {size / theirs:.0f} MB/s"}
    return figures


def slowest(times):
    order = sorted(times, key=times.get, reverse=True)
    return {"value": 1e3 * times[order[0]], "detail": ", ".join(
        f"{tool} {1e3 * times[tool]:.0f}" for tool in order[:4])}


def version(shop, _):
    """Milliseconds of the tool whose --version is slowest."""
    tools = sorted(path.name for path in shop.bin.glob("ritz-*"))
    return {"version": slowest({tool: statistics.median(
        shop.tool(tool, "--version", quiet=False)["wall"]
        for _ in range(shop.starts)) for tool in tools})}


def dualspin(shop, _):
    """Milliseconds of the slowest tool on the dual-spin data."""
    folder = shop.folder / "dualspin"
    (folder / "build").mkdir(parents=True)
    for path in DUALSPIN.iterdir():
        if path.suffix in (".op4", ".bdf", ".yaml"):
            shutil.copy(path, folder)
    times = {}
    for line in (HERE / "starts.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        timed = not line.startswith("- ")
        words = shlex.split(line.removeprefix("- "))
        walls = [shop.tool(*words, folder=folder)["wall"]
                 for _ in range(shop.starts + 1 if timed else 1)]
        if timed:
            times[words[0]] = statistics.median(walls[1:])
    return {"dualspin": slowest(times)}


def damping_of(hertz):
    """Damping a M + b K with 1 % at the first and the tenth flexible mode."""
    hertz = numpy.sort(hertz)
    return rayleigh(hertz[0], hertz[9])


def hankel_words(shop, model):
    """The command that ranks by Hankel values, without its engine."""
    reason = shop.lacks("ritz-rank --engine projection")
    if reason:
        raise Unknown(reason)
    stem, out = shop.stem(model), shop.out(model)
    last = shop.facts[model]["dofs"] // 3
    component = stem.with_suffix(".input.h5")
    shop.tool("ritz-import", *shop.import_words(model),
               "--input", f"pull={last}:1", "--output-at", "near=1:1",
               "--output-at", f"far={last}:3", "-o", component)
    free = out / "ten-modes.h5"
    shop.tool("ritz-basis", "normal-modes", "--modes", 10, component, "-o",
               free)
    with h5py.File(free) as f:
        hertz = f["columns/hertz"][:][f["columns/kind"][:] == b"normal"]
    return ["ritz-rank", "--by", "hankel", "--damping", damping_of(hertz),
            component]


ENOUGH = 52  # times as long: then ADI is stopped, as the best verdict is known


def hankel(shop, model):
    """How many times faster Hankel values are by projection than by low-rank
    ADI. ADI is stopped when the ratio is better than any limit: at least so many
    times, then."""
    words, out = hankel_words(shop, model), shop.out(model)
    fast = statistics.median(
        shop.tool(*words, "--engine", "projection",
                   "-o", out / "hankel.h5")["wall"]
        for _ in range(shop.repeats_of_figures))
    limit = min(shop.limit, ENOUGH * fast)
    try:
        slow, how = shop.tool(*words, "--engine", "low-rank",
                               "-o", out / "adi.h5",
                               limit=limit)["wall"], ""
    except Failed as reason:
        if not reason.late:
            raise
        slow, how = limit, "stopped after "
    return {"hankel": {"value": slow / fast,
                       "detail": f"projection {fast:.3g} s, ADI "
                                 f"{how}{slow:.3g} s"}}


def hankel_error(shop, model):
    """Largest difference of Hankel values by projection and by ADI, relative to
    the largest value."""
    words, out = hankel_words(shop, model), shop.out(model)
    found = []
    for engine in ("projection", "low-rank"):
        path = out / f"hankel-{engine}.h5"
        shop.tool(*words, "--engine", engine, "-o", path, limit=shop.limit)
        with h5py.File(path) as f:
            found.append(f["system_value"][:])
    count = min(map(len, found))
    a, b = (values[:count] for values in found)
    return {"hankel-error": {"value": float(numpy.abs(a - b).max() / b[0]),
                             "detail": f"{count} values"}}


# function, its names, models, those of --quick
FIGURES = [
    (version, ["version"], [""], [""]),
    (dualspin, ["dualspin"], [""], [""]),
    (response, ["response", "response-error"], ["S10", "S50"], ["S10"]),
    (import_output4, ["output4-text", "output4-binary"], ["S10", "S50"],
     ["S10"]),
    (configuration, ["configuration"], ["S50"], []),
    (hankel, ["hankel"], ["S50"], []),
    (hankel_error, ["hankel-error"], ["S10"], []),
    (fit, ["fit"], ["S10", "S50"], []),
]
