"""The rows of targets.toml, evaluated with the results of a run."""
import pathlib
import tomllib

PATH = pathlib.Path(__file__).with_name("targets.toml")
KEYS = {"number", "what", "value", "models", "at_least", "at_most",
        "at_least_128_bit", "stretch"}
NOT_ASKED = "model not asked for"


class NotMeasured(Exception):
    """Why a row has no value."""


def read(path=PATH):
    """The targets, one row for each model (model None if they have none)."""
    rows = []
    for target in tomllib.loads(path.read_text())["target"]:
        stray = set(target) - KEYS
        if stray:
            raise ValueError(f"{path.name}: {target['what']}: {stray}")
        if "at_least" in target and "at_most" in target:
            raise ValueError(f"{path.name}: {target['what']}: two limits")
        target["code"] = compile(target["value"], target["what"], "eval")
        rows += [target | {"model": model}
                 for model in target.get("models", [None])]
    return rows


class Measurements:
    """The functions that formulas call, for one model; keeps what they looked
    up for the column of notes."""

    def __init__(self, result, model):
        self.model = model
        self.runs = result["runs"].get(model, {})
        self.facts = result["models"].get(model, {})
        self.figures = result["figures"].get(model or "", {})
        self.asked = model is None or model in result["runs"]
        self.notes = []

    def run(self, job, key):
        found = self.runs.get(job, {})
        if key in found:
            return found[key]
        if not self.asked:
            raise NotMeasured(NOT_ASKED)
        raise NotMeasured(found.get("why", f"{job}: not part of this run"))

    def note(self, name, value, unit):
        text = f"{name} {value:.3g} {unit}".rstrip()
        if text not in self.notes:
            self.notes.append(text)
        return value

    def wall(self, job):
        return self.note(job, self.run(job, "wall")["median"], "s")

    def cpu(self, job):
        return self.note(job, self.run(job, "cpu")["median"], "s of processor")

    def peak(self, job):
        return self.note(job, self.run(job, "peak")["median"] / 1e6, "MB") * 1e6

    def best(self, *jobs):
        found = {job: self.runs[job]["wall"]["median"] for job in jobs
                 if "wall" in self.runs.get(job, {})}
        if not found:
            self.run(jobs[0], "wall")  # says why
        best = min(found, key=found.get)
        return self.note(best, found[best], "s")

    def residual(self, job):
        return self.run(job, "residual")

    def error(self, job, other):
        key = f"error beside {other}"
        return self.run(job, key)

    def subspaces(self, job, other):
        return self.run(job, f"subspaces beside {other}")

    def peer(self, key):
        if key not in self.facts:
            raise NotMeasured("SLEPc did not run, whose factor is the measure"
                              if self.asked else NOT_ASKED)
        return self.facts[key]

    def figure(self, name):
        if not self.asked:
            raise NotMeasured(NOT_ASKED)
        found = self.figures.get(name, {"why": "not part of this run"})
        if "value" not in found:
            raise NotMeasured(found["why"])
        if found.get("detail"):
            self.notes.append(found["detail"])
        return found["value"]

    def names(self):
        return {"wall": self.wall, "cpu": self.cpu, "peak": self.peak,
                "best": self.best, "residual": self.residual,
                "error": self.error, "subspaces": self.subspaces, "peer": self.peer, "model": self.peer,
                "figure": self.figure, "max": max, "min": min,
                "__builtins__": {}}


def judge(row, value, vector_bits):
    """The verdict (pass, stretch or fail; stated if there is no limit), and the
    limit."""
    least = row.get("at_least")
    if least is not None and vector_bits < 256:
        least = row.get("at_least_128_bit", least)
    most, stretch = row.get("at_most"), row.get("stretch")
    if least is None and most is None:
        return "stated", None
    good = value >= least if least is not None else value <= most
    if not good:
        return "fail", least if least is not None else most
    beyond = stretch is not None and (
        value >= stretch if least is not None else value <= stretch)
    return ("stretch" if beyond else "pass"), (
        least if least is not None else most)


def evaluate(result, rows=None):
    """All rows with values and verdicts, for the report."""
    verdicts = []
    for row in rows or read():
        at = Measurements(result, row["model"])
        said = {key: row.get(key) for key in ("number", "what", "model",
                                              "at_least", "at_most", "stretch")}
        try:
            value = float(eval(row["code"], at.names()))
            verdict, limit = judge(row, value,
                                   result["machine"]["vector_bits"])
            said |= {"value": value, "verdict": verdict, "limit": limit,
                     "notes": ", ".join(at.notes)}
        except NotMeasured as reason:
            said |= {"verdict": "not measured", "notes": str(reason)}
        verdicts.append(said)
    return verdicts
