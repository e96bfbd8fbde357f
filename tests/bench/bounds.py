#!/usr/bin/python3 -s
"""bounds.py FOLDER-OF-THE-TOOLS [--cases N] [--seed N] - check that no proven
bound of a response is below the error of any channel, whatever the damping.

Cases are random: a data set of up to 400 dofs, up to three inputs and outputs
(displacements, velocities, accelerations), a method, an order, a band and a
damping ratio from 0.001 to 0.9. A bound is compared with the error of each
channel relative to its own largest |H|, against the sum of all modes by NumPy,
and with the error of all channels by ritz-verify. Status 1 if a bound is below
either of them.
"""
import pathlib
import random
import sys

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import effectivity  # noqa: E402
import methods  # noqa: E402

RATIOS = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 0.5, 0.7, 0.9]
POINTS = {  # dofs that signals may use: directions, number of grids
    "lund": ("0", 147), "LF10": ("0", 18), "truss72": ("12", 36),
    "rotorAnsys": ("123", 115), "nas2cam outboard": ("123456", 26),
    "dual-spin rotor": ("123456", 79), "dual-spin stator": ("123456", 11)}
LEFT_OUT = {"macneal", "tangential"}  # no response; too slow
# Cases whose bound was too low: data set, signals, method, ratio, band
FOUND = [("truss72", ["--input", "i0=8:2", "--output-at", "o0=3:2"], "irs",
          0.03, 0, 30.863727)]  # rounding makes a mode of a rigid motion
# Channels whose |H| is below this fraction of the largest possible response are
# not coupled
COUPLED = 1e-6
PEAK = 1e-3  # relative to the largest |H|: points miss peaks by this much
ROUNDING = 1e-10  # of what ritz-verify measures


def without(options, *names):
    """The options without those of the given names and their values."""
    pairs = [options[k:k + 2] for k in range(0, len(options), 2)]
    return [word for pair in pairs if pair[0] not in names for word in pair]


def signals(name):
    """Random inputs and outputs of a data set."""
    comps, most = POINTS[name]

    def place():
        return f"{random.randint(1, most)}:{random.choice(comps)}"
    words = []
    for k in range(random.choice([1, 1, 2, 3])):
        words += ["--input", f"i{k}={place()}"]
    for k in range(random.choice([1, 1, 2, 3])):
        kind = random.choice(["", "", "/vel", "/acc"])
        words += ["--output-at", f"o{k}={place()}{kind}"]
    return words


def channels_of(path):
    """B, and [C, Cv, Ca], of a container."""
    with h5py.File(path) as file:
        return (file["inputs/B"][()],
                [file[f"outputs/{c}"][()] for c in ("C", "Cv", "Ca")])


def summed(value, B, C, zeta, w):
    """All channels as sums over modes, and the largest that each could be."""
    w = w[:, None]
    own = numpy.maximum(value, 0)[None]
    Z = own - w**2 + 2j * zeta * w * numpy.sqrt(own)
    c = C[0][None] + 1j * w[:, :, None] * C[1][None] \
        - (w**2)[:, :, None] * C[2][None]
    c_self = (abs(c)**2 / abs(Z)[:, None]).sum(2)
    b_self = (1 / abs(Z)) @ abs(B)**2
    return ((c / Z[:, None]) @ B,
            numpy.sqrt(c_self[:, :, None] * b_self[:, None]))


def points(values, zeta, low, high):
    """Frequencies in a band [rad/s], even ones and some near each pole."""
    f = [numpy.linspace(low, high, 400)]
    for pole in effectivity.hertz(numpy.concatenate(values)):
        f.append(pole * (1 + zeta * numpy.linspace(-6, 6, 121)))
        f.append([pole * numpy.sqrt(max(0, 1 - 2 * zeta**2))])
    f = numpy.unique(numpy.concatenate(f))
    return 2 * numpy.pi * f[(f >= low) & (f <= high) & (f > 0)]


def worst_channel(full, rigid, model, reduced, num_rigid, asked):
    """Largest error of a channel, relative to the scale of its bound."""
    zeta, low, high = asked
    if rigid:
        low = max(low, 1e-3 * high)
    value = full.value.copy()
    value[:rigid] = 0
    B, C = channels_of(model)
    with h5py.File(reduced) as file:
        small, Q = effectivity.small_modes(file["K"][()], file["M"][()])
    small[:num_rigid] = 0
    b, c = channels_of(reduced)
    w = points([value, small], zeta, low, high)
    H, could = summed(value, full.X.T @ B, [k @ full.X for k in C], zeta, w)
    if len(value) < len(full.K):  # static response of massless motions
        A = numpy.linalg.solve(full.K + full.s * full.M, B)
        H = H + C[0] @ A - ((C[0] @ full.X) / (full.value + full.s)) @ (
            full.X.T @ B)
    H_r = summed(small, Q.T @ b, [k @ Q for k in c], zeta, w)[0]
    size = abs(H).max(0)
    size = numpy.where((abs(H) / could).max(0) > COUPLED, size,
                       numpy.minimum(could.max(0), size.max()))
    return (abs(H - H_r).max(0) / numpy.maximum(size, 1e-300)).max()


def estimate(bin_, case, model, method, asked):
    """A reduction of random order and its bound; None if it has no bound."""
    zeta, low, high = asked
    method, how, more = method
    order = int(case["order"] * random.choice([0.5, 0.75, 1, 1.5]))
    basis, reduced = case["folder"] / "basis.h5", case["folder"] / "small.h5"
    columns = methods.make_basis(bin_, method, how, more, model, order,
                                 case["rigid"], basis)
    answer = methods.run(bin_, "ritz-reduce", model, basis, "-o", reduced,
                         "--band-hz", f"{low:.9g},{high:.9g}", "--damping",
                         f"modal {zeta}")
    name = "response-relative-bound"
    found = effectivity.estimates_of(reduced).get(name)
    if found is None:
        return None
    return (reduced, sum(f == 0 for f in answer["frequencies_hz"]),
            f"{method} {columns}", *found, effectivity.cause_of(reduced, name))


def measured(bin_, case, model, reduced, asked):
    """The error of all channels together, by ritz-verify."""
    zeta, low, high = asked
    answer = methods.run(bin_, "ritz-verify", model, reduced, "-o",
                         case["folder"] / "verified.h5", "--band-hz",
                         f"{low:.9g},{high:.9g}", "--damping", f"modal {zeta}")
    return max([m["value"] for m in answer["measures"]
                if m["name"] == "response-relative"], default=0)


def draw_band(hertz):
    """A damping ratio, and a band that ends at or near one of six modes."""
    k = random.randint(1, 6)
    high = (hertz[k - 1] * hertz[k])**0.5 if random.random() < 0.7 \
        else hertz[k - 1] * random.uniform(0.9, 1.3)
    low = 0 if random.random() < 0.7 else high * random.choice([0.01, 0.1, 0.5])
    return random.choice(RATIOS), low, high


def draw(case):
    """A random case: signals, a method, a damping ratio and a band."""
    return (signals(case["name"]), random.choice(
        [m for m in methods.METHODS if m[0] not in LEFT_OUT]),
        draw_band(case["hertz"]))


def found_before(case):
    """The cases of FOUND that belong to this data set."""
    return [(words, methods.some_methods([method])[0], asked)
            for name, words, method, *asked in FOUND if name == case["name"]]


def compare(bin_, case, words, method, asked):
    """Print one case; whether its bound is too low, None if it has none."""
    model = case["folder"] / "model.h5"
    methods.run(bin_, "ritz-import", *case["bare"], *words, "-o", model)
    made = estimate(bin_, case, model, method, asked)
    if made is None:
        return None
    reduced, num_rigid, what, bound, where, cause = made
    error = worst_channel(case["full"], case["rigid"], model, reduced,
                          num_rigid, asked)
    seen = measured(bin_, case, model, reduced, asked)
    low = not (bound >= error * (1 - PEAK) and bound >= seen * (1 - PEAK)
               - ROUNDING)
    print(f"| {case['name']} | {what} | {asked[0]} | {asked[1]:.4g} | "
          f"{asked[2]:.4g} | {bound:.2e} | {error:.2e} | {seen:.2e} | {where} "
          f"| {cause} |" + (" **below** |" if low else ""), flush=True)
    return low


def prepare(bin_, case):
    """The data that all cases of a set share; None if the set is not tested."""
    if case["name"] not in POINTS:
        return None
    case["bare"] = without(case["options"], "--damping", "--input",
                           "--output-at")
    methods.run(bin_, "ritz-import", *case["bare"], "-o", case["component"])
    case["full"] = effectivity.Full(case["component"], case["rigid"])
    f = methods.run(bin_, "ritz-basis", "normal-modes", "--modes", 10,
                    case["component"], "-o",
                    case["folder"] / "modes.h5")["frequencies_hz"]
    case["hertz"] = [x for x in f if x > 0]
    return case


def main():
    """Read the options and run the cases."""
    parser = methods.parser_of(__doc__)
    parser.add_argument("--cases", type=int, default=50, help="of a data set")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    random.seed(asked.seed)
    low = count = 0
    print("| set | method | zeta | from | to | bound | worst channel | "
          "ritz-verify | where | cause |\n" + "|---" * 10 + "|")
    for case in methods.cases(asked.bin, asked.only, most=400):
        if prepare(asked.bin, case) is None:
            continue
        for one in found_before(case) + [draw(case)
                                         for _ in range(asked.cases)]:
            try:
                found = compare(asked.bin, case, *one)
            except methods.Refused:  # a drawn case may leave nothing to reduce
                continue
            count += found is not None
            low += bool(found)
    print(f"\n{count} bounds, {low} below the error")
    return 1 if low or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
