"""What a failure is told with: files for the tools, verdicts, a row and a
section of docs/failures/README.md.

A case is a file of cases/: its docstring, title first, is the section, and
run(it) provokes the failure. It holds the answer of a naive program, written in
that file alone, to be wrong by at least so much, and Ritz to be right to so
much, or to refuse in these words.
"""
import importlib.util
import json
import math
import pathlib
import re
import shlex
import subprocess

import numpy as np
import scipy.io
import scipy.sparse

HERE = pathlib.Path(__file__).resolve().parent
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


class Broken(Exception):
    """What a case held, and what came instead."""


class Failure:
    """One case, on its way."""

    def __init__(self, name, bin_, folder):
        self.name, self.bin, self.folder = name, bin_, folder
        self.verdicts, self.commands, self.pictures = [], [], []
        self.story, self.group, self.cells = '', '', {}

    # --- files and tools ------------------------------------------------------

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def component(self, name, model, *options):
        """ritz-import of a model; the path of the component."""
        for what, matrix in (("K", model.K), ("M", model.M), ("D", model.D)):
            if matrix is not None:
                write_matrix(self.folder / f"{name}.{what}.mtx", matrix)
        words = ["--stiffness", f"{name}.K.mtx", "--mass", f"{name}.M.mtx"]
        if model.D is not None:
            words += ["--damping", f"{name}.D.mtx"]
        self.write(f"{name}.dofs", "".join(
            f"{grid} {component}\n" for grid, component in model.dofs))
        words += ["--dofs", f"{name}.dofs"]
        if model.positions:
            self.write(f"{name}.bdf", "".join(
                f"GRID,{g},,{x:.17g},{y:.17g},{z:.17g}\n"
                for g, (x, y, z) in sorted(model.positions.items())))
            words += ["--bulk", f"{name}.bdf"]
        self.tool("import", *words, *options, "-o", f"{name}.h5", shown=False)
        return f"{name}.h5"

    def states(self, name, A, B, C):
        """ritz-import of a state space."""
        for what, matrix in zip("ABC", (A, B, C)):
            scipy.io.mmwrite(self.folder / f"{name}.{what}.mtx",
                             np.atleast_2d(matrix), precision=17)
        self.tool("import", "--state-space", ",".join(
            f"{w}={name}.{w}.mtx" for w in "ABC"), "-o", f"{name}.h5",
            shown=False)
        return f"{name}.h5"

    def run(self, verb, *words, shown=True):
        """(status, standard output, standard error) of one tool."""
        line = [f"ritz-{verb}", *map(str, words)]
        done = subprocess.run([self.bin / line[0], *line[1:]],
                              cwd=self.folder, capture_output=True, text=True,
                              check=False)
        if shown:
            self.commands.append(shlex.join(line))
        return done.returncode, done.stdout, done.stderr.strip()

    def tool(self, verb, *words, status=0, shown=True):
        """The object that one tool prints for --json."""
        got, out, error = self.run(verb, *words, "--json", shown=False)
        if shown:
            self.commands.append(shlex.join([f"ritz-{verb}",
                                             *map(str, words)]))
        if got != status:
            raise Broken(f"ritz-{verb} exits with {got}, not {status}: {error}")
        return json.loads(out)

    def reduce(self, component, method, *options, out="reduced"):
        """Basis and reduction; the path, and what both tools said."""
        basis = self.tool("basis", method, *options, component, "-o",
                          f"{out}-basis.h5")
        reduced = self.tool("reduce", component, f"{out}-basis.h5", "-o",
                            f"{out}.h5", shown=False)
        return f"{out}.h5", basis, reduced

    def columns(self, run):
        """Values of a run over time by name, "seconds" and diagnostics too."""
        self.tool("export", "--to", "tsv", run, "-o", "run.tsv", shown=False)
        path = self.folder / "run.tsv"
        heads = path.read_text().split("\n")[0].lstrip("# ").split("\t")
        return dict(zip(heads, np.loadtxt(path, ndmin=2).T))

    # --- verdicts ---------------------------------------------------------------

    def holds(self, true, sentence):
        if not true:
            raise Broken(sentence)
        self.verdicts.append(sentence)

    def wrong(self, what, naive, right, least):
        """The naive value is off by at least so much, relative."""
        error = relative(naive, right)
        self.holds(not error < least, f"naive: {what} {show(naive)} where "
                   f"{show(right)} is right is wrong by {least:g} at least")

    def right(self, what, value, right, tolerance):
        """The value of Ritz is right to so much, relative."""
        error = relative(value, right)
        self.holds(error <= tolerance, f"Ritz: {what} {show(value)} is "
                   f"{show(right)} to {tolerance:g}")

    def says(self, words, status, verb, *command):
        """The tool exits so and says so: the line that does."""
        got, out, error = self.run(verb, *command)
        lines = [line.strip() for line in (error + "\n" + out).split("\n")
                 if words in line]
        self.holds(got == status and lines,
                   f"Ritz: '{words}', status {status}, of ritz-{verb}"
                   + ("" if lines and got == status else
                      f"; but {got}, {error or out}"))
        self.commands.append(f"    {clean(lines[0])}")
        return lines[0]

    def notes(self, answer, words):
        """A warning in an answer to --json."""
        lines = [w for w in answer["warnings"] if words in w]
        self.holds(lines, f"Ritz: warns of '{words}'"
                   + ("" if lines else f"; but of {answer['warnings']}"))
        self.commands.append(f"    warning: {clean(lines[0])}")
        return lines[0]

    # --- what is shown ------------------------------------------------------------

    def row(self, naive, right, ritz):
        """Of the table; numbers are held to two digits."""
        self.cells = {"naive": naive, "right": right, "ritz": ritz}

    def picture(self, script, caption, **data):
        """SVG by gnuplot; each array is there as the block $NAME."""
        self.pictures.append((script, caption, data))


def growth_of(line):
    """Real part of the pole that a sentence names."""
    return float(re.search(r"pole at ([-+][0-9.e+-]*[0-9])", line).group(1))


def relative(value, right):
    """Largest error of an array over the largest right value."""
    value, right = np.atleast_1d(value), np.atleast_1d(right)
    if value.shape != right.shape or not np.all(np.isfinite(value)):
        return math.inf
    return float(np.max(np.abs(value - right)) / np.max(np.abs(right)))


def show(value):
    values = np.atleast_1d(value)
    text = " ".join(f"{v:.6g}" for v in values[:6])
    return text + (" ..." if len(values) > 6 else "")


def clean(line):
    return re.sub(r"\s+", " ", line)


def write_matrix(path, A):
    """Matrix Market, 17 digits, of the lower triangle if it is symmetric."""
    A = np.asarray(A)
    symmetric = np.array_equal(A, A.T)
    scipy.io.mmwrite(path, scipy.sparse.coo_matrix(
        np.tril(A) if symmetric else A), precision=17,
        symmetry="symmetric" if symmetric else "general")


def names():
    return sorted(path.stem.replace("_", "-")
                  for path in (HERE / "cases").glob("*.py"))


def load(name):
    """Module of a case."""
    path = HERE / "cases" / (name.replace("-", "_") + ".py")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
