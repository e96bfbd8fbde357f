#!/usr/bin/python3 -s
"""simulators.py FOLDER-OF-THE-TOOLS - docs/simulators.md can be followed.

The commands of each section are run in their order, in a folder of its own
next to `data` of the repository. Files that a section imports and that do not
exist are made: models of beams with the grids that the command names. Blocks in
Python are run if the packages that they import are installed, and blocks in
Octave if Octave is; with_page.py runs this script where more is installed. A
block behind a line that ends with "`NAME`:" is the file NAME. Where a section
says "It prints `TEXT`", a block does.
"""
import importlib.util
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from common import DATA, skip

try:
    import scipy.sparse
except ImportError as missing:
    skip(missing)

from beam import beam

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]
                    / "bench" / "speed"))
import output4  # noqa: E402

PAGE = DATA.parent / "docs" / "simulators.md"
BIN = pathlib.Path(sys.argv[1]).resolve()
# the exporter of containers, which no simulator reads
OWN = {"container"}


def check(holds, sentence, figures=""):
    check.count += 1
    print("ok" if holds else "not ok", check.count, "-", sentence, flush=True)
    if not holds:
        sys.exit("\n".join("# " + line for line in figures.splitlines()))


check.count = 0


def run(command, folder):
    """Status and what is printed."""
    path = f"{BIN}:{os.environ['PATH']}"
    done = subprocess.run(command, cwd=folder, text=True,
                          env=dict(os.environ, PATH=path),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


# --- what the page tells the user to do ---------------------------------------

def blocks(text):
    """Kind, lines and the line before, of each fenced or indented block; an
    indented one may have empty lines."""
    kind, lines, before, last = None, [], "", ""
    for line in text.splitlines():
        fence = re.match(r"```(\w*)", line)
        if kind == "indented" and line.strip() and line[:4] != "    ":
            yield kind, lines, before
            kind = None
        if kind is None:
            if fence or (line[:4] == "    " and line.strip()):
                kind = (fence[1] or "text") if fence else "indented"
                lines, before = [] if fence else [line[4:]], last
            elif line.strip():
                last = line
        elif fence and kind != "indented":
            yield kind, lines, before
            kind = None
        else:
            lines.append(line[4:] if kind == "indented" else line)
    if kind:
        yield kind, lines, before


def commands(lines):
    """Each command of a block with the output that is quoted below it, which
    begins with the name of the file that the command writes."""
    found, quoted = [], False
    for line in "\n".join(lines).replace("\\\n", " ").splitlines():
        if line.startswith("ritz-"):
            found.append((shlex.split(line, comments=True), []))
            quoted = False
        elif found and line.strip():
            first = line.split()[0]
            quoted = quoted or (
                first[-1] == ":" and first[:-1] == found[-1][0][-1])
            if quoted and line.strip() != "...":
                found[-1][1].append(line)
    return found


# --- models that a section imports --------------------------------------------

def grids_of(command):
    """Grids that options such as --port NAME=1-4,7:123 name."""
    grids = set()
    for option, value in zip(command, command[1:]):
        if option in ("--port", "--rigid-port", "--averaged-port", "--input",
                      "--output-at"):
            for part in re.split("[,;]", value.split("=", 1)[1]):
                ends = re.match(r"(\d+)(?:-(\d+))?", part)
                grids.update(range(int(ends[1]), int(ends[2] or ends[1]) + 1))
    return sorted(grids)


def write_model(folder, stem, grids):
    """A beam of eight elements from each of these grids to the next, and a body
    at the first, as NAME.op4 and NAME.bdf."""
    cells = 8 * max(1, len(grids) - 1)
    spare = iter(range(max(grids) + 1, max(grids) + cells + 2))
    ids = [grids[k // 8] if k % 8 == 0 and k // 8 < len(grids)
           else next(spare) for k in range(cells + 1)]
    K, M = beam(5.0, cells, 300.0, (150.0, 250.0, 300.0))
    rows = [6 * k + c for k in sorted(range(len(ids)), key=lambda k: ids[k])
            for c in range(6)]
    output4.write(folder / f"{stem}.op4", **{
        name: scipy.sparse.csc_matrix(A[rows][:, rows])
        for name, A in (("KGG", K), ("MGG", M))})
    (folder / f"{stem}.bdf").write_text("BEGIN BULK\n" + "".join(
        f"GRID,{grid},,{5.0 * k / cells!r},0.,0.\n"
        for k, grid in enumerate(ids)) + "ENDDATA\n", encoding="ascii")


def provide(command, folder):
    """Models that the command reads and that are not there."""
    for word in command[1:]:
        name = re.match(r"([\w-]+)\.(op4|bdf)(:\w+)?$", word)
        if name and command[0] == "ritz-import" and not (
                folder / f"{name[1]}.{name[2]}").exists():
            write_model(folder, name[1], grids_of(command))


# --- following a section ------------------------------------------------------

def squeeze(text):
    return " ".join(text.split())


def follow_command(heading, command, quoted, folder):
    provide(command, folder)
    status, said = run(command, folder)
    sentence = f"{heading}: {shlex.join(command)}"
    check(status == 0, sentence, f"status {status}\n{said}")
    lines = {squeeze(line) for line in said.splitlines()}
    for line in quoted:
        check(squeeze(line) in lines, f"{heading}: and prints {squeeze(line)}",
              said)


def missing_modules(script, folder):
    names = re.findall(r"^(?:import|from) (\w+)", script, re.M)
    return [name for name in sorted(set(names))
            if not (folder / f"{name}.py").exists()
            and importlib.util.find_spec(name) is None]


def follow_script(heading, kind, script, folder):
    """What a block of Python or of Octave prints; None where that is not."""
    missing = missing_modules(script, folder) if kind == "python" else \
        [] if shutil.which("octave-cli") else ["octave-cli"]
    if missing:
        check(True, f"{heading}: a block in {kind.capitalize()} # skip no "
              f"{', '.join(missing)}")
        return None
    status, said = run(
        [sys.executable, "-s", "-B", "-c", script] if kind == "python"
        else ["octave-cli", "--norc", "--eval", script], folder)
    check(status == 0, f"{heading}: the block in {kind.capitalize()} runs",
          said)
    return said


def compare_quotes(heading, text, said):
    """Unless a block was skipped."""
    if None in said:
        return
    for quoted in re.findall(r"\bIt prints `([^`]+)`", text):
        check(any(quoted in words for words in said),
              f"{heading}: it prints {quoted}", "\n".join(said))


def follow(heading, text):
    said = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "data").symlink_to(DATA)
        for kind, lines, before in blocks(text):
            name = re.search(r"`([\w./-]+)`:$", before)
            if name and kind != "indented":
                (folder / name[1]).write_text("\n".join(lines) + "\n",
                                              encoding="utf-8")
            elif kind in ("python", "octave"):
                said.append(follow_script(heading, kind, "\n".join(lines),
                                          folder))
            elif kind in ("indented", "sh", "text"):
                for command, quoted in commands(lines):
                    follow_command(heading, command, quoted, folder)
    compare_quotes(heading, text, said)


def check_table(head):
    """The table has a row for each exporter of models, and no other."""
    listed = {line.split()[0] for line in run(
        ["ritz-export", "--list"], ".")[1].splitlines()
        if line.split()[1:2] == ["reduced"]} - OWN
    rows = set(re.findall(r"^\| `(\w[^`]*)` \|", head, re.M))
    check(listed == rows, "the table has the exporters of models",
          " ".join(sorted(listed ^ rows)))


def main():
    head, *rest = re.split(r"^## (.+)\n", PAGE.read_text(encoding="utf-8"),
                           flags=re.M)
    check_table(head)
    for heading, text in zip(rest[::2], rest[1::2]):
        follow(heading, text)
    print(f"1..{check.count}")


if len(sys.argv) != 2:
    sys.exit(__doc__)
main()
