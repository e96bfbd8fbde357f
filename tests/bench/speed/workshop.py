"""The programs of a run, ours and those of others, its files of models, and its
processes."""
import json
import pathlib
import shutil
import subprocess
import sys
import time
import tomllib

import machine
import quality

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
USUAL, QUICK = ["S10", "P50", "S50", "S150"], ["S10", "P50"]
LARGE = ["S400", "S1000"]  # their files are on the disk

TOOLS = {"RITZ_SYNC": "0"}  # and nothing else: no file need outlive a cut
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
ONE_THREAD = {"OMP_NUM_THREADS": "1"}  # threads of small products only wait


def say(shop, *what):
    """Print on standard error what the run does now."""
    print(f"{shop.elapsed():8.1f} s ", *what, file=sys.stderr, flush=True)


def build(name, compiler, libraries, folder):
    """Compile NAME.c of this folder: a command, or a text that says why it
    cannot be compiled."""
    flags = machine.said("pkg-config", "--cflags", "--libs", *libraries)
    if not flags:
        return f"pkg-config does not find {' and '.join(libraries)}"
    program = folder / name
    try:
        done = subprocess.run(
            [*compiler, "-std=gnu2x", "-O3", HERE / f"{name}.c",
             "-o", program, *flags.split()], capture_output=True, text=True)
    except OSError as error:
        return f"{compiler[0]}: {error.strerror}"
    if done.returncode != 0:
        return f"{name}.c: {(done.stderr.strip() or 'failed').splitlines()[0]}"
    return [program]


def find(program, *command):
    return list(command) if shutil.which(program) else f"no {program}"


def find_module(python, module, *command):
    """The command of a Python if it has a module, else a text that says so."""
    if machine.said(python, "-c", f"import {module}; print(1)") != "1":
        return f"no {module} in build/interop"
    return [python, *command]


class Workshop:
    """Programs, files and processes of one run."""

    def __init__(self, arguments, stopwatch):
        self.bin = pathlib.Path(arguments.tools).resolve()
        self.build = ROOT / "build" / "bench"
        self.disk = self.build / "models"
        self.quick, self.only = arguments.quick, arguments.only
        self.repeats = arguments.repeats
        if self.repeats is None:
            self.repeats = 3 if self.quick else 5
        self.repeats_of_figures = 1 if self.quick else max(self.repeats, 1)
        self.starts = 10 if self.quick else 50
        self.limit = arguments.limit
        self.models = arguments.models or (QUICK if self.quick else USUAL)
        self.stopwatch = stopwatch
        self.folder = None  # for files, as long as measurements last
        self.began = time.monotonic()
        self.programs, self.help, self.facts = {}, {}, {}
        self.jobs = tomllib.loads((HERE / "jobs.toml").read_text())

    def elapsed(self):
        return time.monotonic() - self.began

    def wants(self, name):
        return not self.only or name in self.only

    # programs

    def prepare(self):
        self.build.mkdir(parents=True, exist_ok=True)
        python = self.build.parent / "interop" / "bin" / "python"
        self.programs = {
            "limits": build("limits", ["gcc", "-fopenmp", "-march=native",
                                       "-ffast-math"], ["openblas"],
                            self.build),
            "peer-slepc": build("peer_slepc", ["mpicc"], ["slepc", "petsc"],
                                self.build),
            "mpirun": find("mpirun", "mpirun"),
            "peer-scipy": ["/usr/bin/python3", "-s", HERE / "peer_scipy.py"],
            "peer-octave": find("octave", "octave", "--no-gui", "-qf",
                                "--norc", HERE / "peer_octave.m"),
            "peer-calculix": find("ccx", "sh", HERE / "peer_calculix.sh"),
            "peer-exudyn": find_module(python, "exudyn",
                                       HERE / "peer_exudyn.py"),
            "peer-pyyeti": find_module(python, "pyyeti"),
        }

    def program(self, name):
        """The command of a program; raises Unknown if it is not available."""
        found = self.programs[name]
        if isinstance(found, str):
            raise quality.Unknown(found)
        return found

    def option(self, tool, option):
        """The lines of a tool's --help on an option; None if it has none."""
        if tool not in self.help:
            self.help[tool] = machine.said(self.bin / tool, "--help")
        text, within = [], False
        for line in self.help[tool].splitlines():
            words = line.split()
            if line.startswith("  -"):
                within = option in [word.strip(",") for word in words[:3]]
            elif not line.startswith("    "):
                within = False
            if within:
                text += words
        return " ".join(text) or None

    def lacks(self, need):
        """Why `TOOL --OPTION [WORD]` cannot be run; None if it can."""
        tool, option, *word = need.split()
        text = self.option(tool, option)
        if text is None:
            return f"{tool} has no {option}"
        if word and word[0] not in text.replace(",", " ").split():
            return f"{tool} has no {option} {word[0]}"
        return None

    # files

    def stem(self, model):
        folder = self.disk if model in LARGE else self.folder
        folder.mkdir(parents=True, exist_ok=True)
        return folder / model

    def out(self, model):
        folder = self.stem(model).with_suffix(".out")
        folder.mkdir(exist_ok=True)
        return folder

    def port(self, model):
        return self.stem(model).with_suffix(".port").read_text()

    def import_words(self, model, port=True, matrices=None):
        stem = self.stem(model)
        matrices = matrices or stem.with_suffix(".op4")
        words = ["--stiffness", f"{matrices}:K", "--mass", f"{matrices}:M",
                 "--bulk", stem.with_suffix(".bdf"),
                 "--dofs", stem.with_suffix(".dofs")]
        if port:
            words += ["--port", f"face={self.port(model)}:123"]
        return words

    def make_model(self, model):
        stem = self.stem(model)
        subprocess.run(["/usr/bin/python3", "-s", "-B", HERE / "models.py",
                        model, stem.parent], check=True)
        self.facts[model] = json.loads(stem.with_suffix(".json").read_text())
        self.tool("ritz-import", *self.import_words(model), "-o",
                  stem.with_suffix(".h5"))

    # processes

    def tool(self, tool, *words, folder=None, limit=None, quiet=True):
        return self.stopwatch(
            [self.bin / tool, *(["-q"] if quiet else []), *words],
            machine.environment(**TOOLS), folder or self.folder,
            limit or self.limit)

    def peer(self, command, **more):
        return self.stopwatch(command, machine.environment(**MPI, **more),
                              self.folder, self.limit)

    def command(self, job, model):
        """The words of a job's command, with paths in place of names."""
        words = []
        for word in self.jobs[job]["command"].split():
            if word in self.programs:
                words += self.program(word)
            elif word.startswith("ritz-"):
                words.append(self.bin / word)
            else:
                words.append(word.format(model=self.stem(model),
                                         out=self.out(model)))
        return words

    def why_not(self, job, model):
        """Why a job cannot run on a model; None if it can; "" if it is not
        meant for this model."""
        row = self.jobs[job]
        if model not in row.get("models", [model]) or not self.wants(job):
            return ""
        for need in row.get("needs", []):
            if reason := self.lacks(need):
                return reason
        if self.quick and not row.get("quick"):
            return "not part of --quick"
        try:
            self.command(job, model)
        except quality.Unknown as reason:
            return str(reason)
        return None

    def run(self, job, model):
        row = self.jobs[job]
        ours = row["command"].split()[0].startswith("ritz-")
        command, record = self.command(job, model), self.out(model) / "record"
        record.unlink(missing_ok=True)  # of a run that failed
        if ours:
            more = TOOLS
            command += ["--record", record]
        else:
            more = MPI | TOOLS | row.get("environment", ONE_THREAD)
        done = self.stopwatch(command, machine.environment(**more),
                              self.folder, self.limit)
        if ours:
            done["said"] = {
                "phases": json.loads(record.read_text())["phases"]}
        elif done["out"].startswith("{"):
            done["said"] = json.loads(done["out"])
            done["peak"] = done["said"].get("peak_bytes", done["peak"])
        return done
