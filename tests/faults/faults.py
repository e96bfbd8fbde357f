"""Makes commands of the tools fail; faults.sh prepares the files.

Usage: faults.py FOLDER PRELOAD TRIES [KIND]..., with the tools on the PATH.

FOLDER/cases has one case per line, as for tests/fuzz/damage.py, but no file is
damaged here. Each command runs once without a fault, then TRIES times with a
fault of each KIND (by default of all), at points spread over its run:

    memory   an allocation fails, of Ritz or of a library
    write    a call that writes to a file fails
    disk     files are limited to a number of bytes
    kill     SIGKILL at a call that writes, then the command once more

The command must end with status 1, one sentence and no output. If a library
does without the memory, status 0 and the same output as without a fault are
right. A signal is a finding if it came in code of Ritz, or after an allocation
of Ritz; otherwise the table counts it for the library. The tools contain static
archives of libraries: a function that is not in libritz.a or libritz_cli.a
belongs to a library. A killed command leaves a complete output or none, and the
next run removes its drafts.
"""
import bisect
import functools
import os
import pathlib
import random
import resource
import shlex
import shutil
import subprocess
import sys

LIMIT = 120.0  # seconds
KINDS = ("memory", "write", "disk", "kill")


@functools.cache
def own_functions(build):
    """Names of the functions in libritz.a and libritz_cli.a of a build."""
    lists = subprocess.run(
        ["nm", "--defined-only", build / "libritz.a", build / "libritz_cli.a"],
        capture_output=True, text=True, check=True).stdout
    words = [line.split() for line in lists.splitlines()]
    return {w[2] for w in words if len(w) == 3 and w[1] in "tT"} | {"main"}


@functools.cache
def program_functions(program):
    """Addresses of all functions in a program, ascending, and their names."""
    lists = subprocess.run(["nm", "-n", "--defined-only", program],
                           capture_output=True, text=True, check=True).stdout
    words = [line.split() for line in lists.splitlines()]
    rows = [(int(w[0], 16), w[2]) for w in words
            if len(w) == 3 and w[1] in "tTwWi"]
    return [row[0] for row in rows], [row[1] for row in rows]


def is_own(program, offset):
    """Whether the function at an offset in a tool is one of Ritz. GCC splits
    functions; the parts NAME.cold and NAME.isra.0 belong to NAME."""
    addresses, names = program_functions(program)
    at = bisect.bisect_right(addresses, offset) - 1
    build = pathlib.Path(program).resolve().parent.parent
    return names[at].split(".")[0] in own_functions(build)


class Run:
    """One run: its status, its sentences, the log of the preloaded library."""

    def __init__(self, folder, words, fault=None, preload=None, room=None):
        log = folder / "fault.log"
        log.unlink(missing_ok=True)
        environment = dict(os.environ)
        if preload:
            environment.update(LD_PRELOAD=preload, RITZ_FAULT=fault,
                               RITZ_FAULT_LOG=str(log))

        def limit():
            if room is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))
        run = subprocess.run(words, cwd=folder, capture_output=True,
                             timeout=LIMIT, text=True, errors="replace",
                             stdin=subprocess.DEVNULL, env=environment,
                             preexec_fn=limit)
        self.status = run.returncode
        warning = f"{words[0]}: warning: "
        self.sentences = [line for line in run.stderr.splitlines()
                          if not line.startswith(warning)]
        lines = log.read_text().splitlines() if log.exists() else []
        self.notes = dict(line.split(" ", 1) for line in lines)
        log.unlink(missing_ok=True)

    def calls(self):
        return int(self.notes.get("calls", 0))

    def home(self, note):
        """Whose code a note names: "ours", "libc" or "other"."""
        program, _, offset = self.notes.get(note, "").rpartition("+")
        name = os.path.basename(program)
        if name.startswith("ritz"):
            program = shutil.which(name)
            return "ours" if is_own(program, int(offset, 16)) else "other"
        return ("libc" if name.startswith("libc.so") or not name else "other")

    def is_foreign(self):
        """Whether a library ended the run, or printed sentences of its own,
        after one of its allocations failed."""
        return self.home("failed") == "other" and (
            self.status not in (0, 1) and self.home("signal") != "ours" or
            len(self.sentences) > 1)


class Case:
    """A command, and the files that it writes without a fault."""

    def __init__(self, folder, place, words, preload):
        self.folder, self.place, self.words = folder, place, words
        self.preload = preload
        self.clear()
        self.sound = Run(place, words)
        self.made = self.outputs()

    def clear(self):
        shutil.rmtree(self.place, ignore_errors=True)
        shutil.copytree(self.folder, self.place, symlinks=True)
        self.before = set(os.listdir(self.place))

    def outputs(self):
        return {name: (self.place / name).read_bytes()
                for name in set(os.listdir(self.place)) - self.before}

    def remove_outputs(self):
        for name in set(os.listdir(self.place)) - self.before:
            (self.place / name).unlink()

    def count(self, kind):
        """Number of possible faults of a kind."""
        if kind == "disk":
            return max(map(len, self.made.values()), default=0)
        self.remove_outputs()
        return Run(self.place, self.words, f"{kind}:0", self.preload).calls()

    def meet(self, kind, number):
        """Run with one fault. Returns what is wrong with the run, or None, and
        whether a library ended it."""
        self.remove_outputs()
        if kind == "disk":
            run = Run(self.place, self.words, room=number - 1)
        else:
            run = Run(self.place, self.words, f"{kind}:{number}", self.preload)
        left = self.outputs()
        if kind == "kill":
            return self.judge_killed(run, left), False
        if run.is_foreign() and all(
                name.endswith(".part") for name in left):
            return None, True
        if run.status == 0:
            if kind != "memory":
                return "status 0", False
            return (None if left == self.made else
                    f"status 0, and other bytes: {run.notes}"), False
        if left:
            return f"left {sorted(left)}", False
        if len(run.sentences) != 1:
            return (f"status {run.status}: {run.notes}: "
                    f"{run.sentences[:4]}"), False
        return (None if run.status == 1 else
                f"status {run.status}: {run.notes}"), False

    def judge_killed(self, run, left):
        if run.status != -9:
            return f"status {run.status}, not killed"
        for name, content in left.items():
            if not name.endswith(".part") and content != self.made.get(name):
                return f"half of '{name}'"
        again = Run(self.place, self.words)
        if again.status != 0 or self.outputs() != self.made:
            return (f"the next run: status {again.status}, "
                    f"{sorted(self.outputs())}")
        return None


def main():
    folder, preload = pathlib.Path(sys.argv[1]), sys.argv[2]
    tries = int(sys.argv[3])
    kinds = sys.argv[4:] or KINDS
    for kind in kinds:
        if kind not in KINDS:
            sys.exit(f"no kind '{kind}', there are {', '.join(KINDS)}")
    lines = (folder / "cases").read_text().splitlines()
    (folder / "cases").unlink()
    rng = random.Random(1)
    total = {kind: [0, 0, 0] for kind in kinds}
    for number, line in enumerate(lines):
        name, *words = shlex.split(line)
        words = [word.replace("@", name) for word in words]
        case = Case(folder, folder.parent / "run", words, preload)
        if case.sound.status != 0:
            print(f"passed over, as it fails without a fault: "
                  f"{shlex.join(words)}: {case.sound.sentences}", flush=True)
            continue
        for kind in kinds:
            calls = case.count(kind)
            if calls == 0:
                continue
            met = total[kind]
            for k in range(tries):
                at = 1 + (k * calls + rng.randrange(calls)) // tries
                wrong, foreign = case.meet(kind, at)
                met[0] += 1
                met[1] += foreign
                if wrong:
                    met[2] += 1
                    print(f"{kind} {at} of {calls}: {shlex.join(words)}: "
                          f"{wrong}", flush=True)
    print("| fault  |  runs | ended by a library | findings |\n"
          "|---|---|---|---|")
    for kind, (runs, foreign, found) in total.items():
        print(f"| {kind:6} | {runs:5} | {foreign:18} | {found:8} |")
    sys.exit(1 if any(found for _, _, found in total.values()) else 0)


main()
