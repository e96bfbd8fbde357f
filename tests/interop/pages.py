#!/usr/bin/python3 -s
"""pages.py FOLDER-OF-THE-TOOLS - the commands of docs/import.md turn foreign
files into files that Ritz reads. The script of docs/container.md writes a
component; without a member that the page does not call optional, it is refused.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy
    import scipy.io
    import scipy.sparse
except ImportError as missing:
    print("skipped:", missing)
    sys.exit(77)

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"
BIN = pathlib.Path(sys.argv[1]).resolve()
EXTERNAL = pathlib.Path(os.environ.get("RITZ_EXTERNAL_DATA", "absent"))
# of two grids with three directions each; no entry has few digits
K = numpy.diag([1000.5, 2000.25, 3000.125] * 2)
K[0, 3] = K[3, 0] = -1000.0 / 3.0
K[1, 2] = K[2, 1] = 1.0 / 7.0
M = numpy.diag([2.0, 2.0, 2.0, 3.0, 3.0, 3.0])


def section(page, heading):
    text = (DOCS / page).read_text(encoding="utf-8")
    return re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", text, re.M | re.S)[1]


def blocks(text, language):
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.M | re.S)


def run(*command):
    done = subprocess.run([str(word) for word in command], text=True,
                          capture_output=True)
    return done.returncode, done.stdout + done.stderr


def tool(name, *words):
    return run(BIN / name, *words)


def check(holds, sentence, figures=""):
    check.count += 1
    print("ok" if holds else "not ok", check.count, "-", sentence, flush=True)
    if not holds:
        sys.exit(f"# {figures}")


check.count = 0


# --- a component from a script ------------------------------------------------

def members(text):
    """For each row of a table: name, type and whether it is optional."""
    for row in re.findall(r"^\| `([^`]+)` \| ([^|]+) \|", text, re.M):
        yield row[0], row[1], "optional" in row[1]


def without(path, name, attribute):
    """A copy of a container without one of its members."""
    shutil.copy("two.h5", path)
    with h5py.File(path, "a") as file:
        del (file.attrs if attribute else file)[name]


def write_component():
    text, = blocks(section("container.md", "Writing one"), "python")
    pathlib.Path("two.py").write_text(text, encoding="utf-8")
    status, said = run("/usr/bin/python3", "-s", "two.py")
    check(status == 0, "the script of the page writes a component", said)
    status, said = tool("ritz-check", "two.h5")
    check(status == 0, "ritz-check takes it", said)
    status, said = tool("ritz-basis", "normal-modes", "--modes", 1, "two.h5",
                        "-o", "basis.h5")
    hertz = numpy.sqrt(200.0 * (1.0 + 0.5)) / (2.0 * numpy.pi)
    check(status == 0, "it has modes", said)
    with h5py.File("basis.h5") as file:
        found = file["columns/hertz"][:]
    check(abs(found - hertz).min() < 1e-9, "and its frequency", found)
    with h5py.File("two.h5", "a") as file:
        file.copy("K", "D")
        file.copy("K", "K4")


def drop_members():
    head = section("container.md", "In every file")
    component = section("container.md", "component")
    shared = section("container.md", "Members that several kinds share")
    ends = re.search(r"### inputs and outputs\n(.*?)\n###", shared, re.S)[1]
    rows = [(name, True, False)
            for name in re.findall(r"^\| `(\w+)` \|", head, re.M)]
    rows += [(name, "attribute" in kind, optional)
             for name, kind, optional in members(component) if "<" not in name]
    rows += [(name, False, False) for name, _, _ in members(ends)]
    rows += [("ports", False, False), ("inputs", False, True),
             ("outputs", False, True)]
    for name, attribute, optional in rows:
        without("less.h5", name, attribute)
        status, said = tool("ritz-info", "less.h5")
        check((status == 0) == optional,
              f"{name} {'may be absent' if optional else 'must exist'}", said)


def change_types():
    """Other types than the page states are refused, narrower ones are read."""
    for name, value, due in (("dofs/grid", [1.0, 2.0], 1),
                             ("inputs/B", [[1], [0]], 1),
                             ("inputs/names", ["push"], 1),
                             ("dofs/component", numpy.zeros(2, "i4"), 0),
                             ("inputs/B", numpy.array([[1], [0]], "f4"), 0)):
        without("other.h5", name, False)
        with h5py.File("other.h5", "a") as file:
            file[name] = value
        status, said = tool("ritz-info", "other.h5")
        check(status == due, f"{name} of another type is "
              f"{'refused' if due else 'read'}", said)


# --- files that are recognised and not read -----------------------------------

def entries(A, both):
    return [(i + 1, j + 1, float(A[i, j])) for j in range(6) for i in range(6)
            if A[i, j] != 0.0 and (both or i <= j)]


def put(name, lines):
    pathlib.Path(name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_samples():
    market = ["MatrixMarket matrix coordinate real general", "6 6 10"]
    text = [f"{i} {j} {value!r}" for i, j, value in entries(K, True)]
    put("header.mtx", ["%" + market[0], *market[1:], *text])
    for name, A in (("STIF1", K), ("MASS1", M)):
        put(f"part_{name}.mtx",
            [f"{i} {j} {v:.15e}" for i, j, v in entries(A, True)])
    for name, A in (("sti", K), ("mas", M)):
        put(f"part.{name}",
            [f"{i} {j}  {v:.13e}" for i, j, v in entries(A, False)])
    put("part.dof", [f"{n}.{c}" for n in (11, 12) for c in (1, 2, 3)])
    put("part.inp", ["*Heading", "** two nodes", "*Node",
                     "     11,  0.,  0.,  0.5", "12, 1.5, 0., 0.",
                     "*Element, type=T3D2", "1, 11, 12", "*Step",
                     "*Matrix generate, stiffness, mass", "*Node Output", "U"])
    pathlib.Path("file.full").write_bytes(
        bytes([100, 0, 0, 0, 0, 0, 0, 128, 4, 0, 0, 0]) + bytes(400))
    put("nodes.txt", ["Node Number\tX Location", "1\t0.5"])


def recognise(path):
    """The format as which ritz-info and ritz-import recognise a file."""
    status, said = tool("ritz-info", path)
    found = re.search(r"looks like (.*), which is not read: .* as "
                      r"docs/import\.md shows", said)
    check(status == 1 and found, f"{pathlib.Path(path).name} is recognised",
          said)
    status, again = tool("ritz-import", "--mass", "M.mtx", "--stiffness", path,
                         "-o", "none.h5")
    check(status == 1 and found[1] in again, "also by --stiffness", again)
    return found[1]


def check_matrix(sentence, allowed=0.0):
    status, said = tool("ritz-info", "K.mtx")
    check(status == 0, f"{sentence}: what was made is read", said)
    error = abs(scipy.io.mmread("K.mtx").toarray() - K).max()
    check(error <= allowed, "and is the matrix", error)
    os.remove("K.mtx")


def convert():
    text = section("import.md", "Files that are recognised and not read")
    header, = blocks(text, "sh")
    check(run("sh", "-c", header)[0] == 0, "a header gets its %")
    check_matrix("header")
    scipy.io.mmwrite("K.mtx", scipy.sparse.csc_matrix(K), precision=17)
    check_component("ANSYS", command_of(text), 0.0)
    os.remove("K.mtx")
    text = section("import.md", "Recipes")
    for code, allowed in (("CalculiX", 1e-9), ("Abaqus", 1e-11)):
        recipe = re.search(rf"^### {code}\n(.*?)(?=^### |\Z)", text,
                           re.M | re.S)[1]
        check_component(code, command_of(recipe), allowed)


def command_of(text):
    return re.search(r"^    (ritz-import .*)$", text, re.M)[1].split()


def check_component(origin, command, allowed):
    """The component of a command of the page, by its matrix and its grids."""
    status, said = tool(*command)
    check(status == 0, f"matrices of {origin} are imported", said)
    with h5py.File("part.h5") as file:
        check(list(file["grids/id"]) == [11, 12] and numpy.array_equal(
            file["grids/position"][:], [[0, 0, 0.5], [1.5, 0, 0]]) and
            list(file["dofs/component"]) == [1, 2, 3] * 2, "grid by grid")
        stored = file["K"]
        A = scipy.sparse.csc_matrix(tuple(
            stored[part][:] for part in ("data", "indices", "indptr")))
        error = abs(A.toarray() - K).max()
    check(error <= allowed, "with their stiffness", error)
    os.remove("part.h5")


def convert_external():
    if not EXTERNAL.exists():
        print("# skipped: no external data")
        return
    for name, kind in (("calculix/conrod/conrod.dof", "dofs of CalculiX"),
                       ("ansys/rotorAnsysNodalCoordinates.txt", "ANSYS")):
        status, said = tool("ritz-info", EXTERNAL / name)
        check(status == 1 and kind in said, f"{name} is recognised", said)
    for name, what in (("calculix/conrod/conrod.sti", "coordinates"),
                       ("abaqus/blockC3D4_STIF1.mtx", "coordinates"),
                       ("calculix/conrod/conrod.inp", "input file of Abaqus"),
                       ("abaqus/blockC3D10.inp", "input file of Abaqus")):
        status, said = tool("ritz-info", EXTERNAL / name)
        check(status == 0 and what in said, f"{name} is read", said)


# --- matrices of Abaqus and CalculiX that name their rows ---------------------
#
# Files are written here from the layouts of the manuals; CalculiX writes its
# own where it is installed.

NAMES = [(node, direction) for node in (11, 12) for direction in (1, 2, 3)]


def lower_rows(A):
    """Rows of the lower triangle on lines of four numbers."""
    for i in range(6):
        numbers = [repr(float(value)) for value in A[i, :i + 1]]
        for k in range(0, len(numbers), 4):
            yield ", ".join(numbers[k:k + 4])


def write_named():
    for name, A in (("part_STIF1.mtx", K), ("part_MASS1.mtx", M)):
        put(name, [f"{NAMES[i][0]},{NAMES[i][1]}, {NAMES[j][0]},{NAMES[j][1]}, "
                   f"{float(A[i, j])!r}" for j in range(6) for i in range(j, 6)
                   if A[i, j] != 0.0])
    put("part.mtx", ["** SUBSTRUCTURE", "*USER ELEMENT, NODES= 2, LINEAR",
                     "** ELEMENT NODES", "** 11, 12", "1, 2, 3",
                     "*MATRIX,TYPE=STIFFNESS", *lower_rows(K),
                     "*MATRIX,TYPE=MASS", *lower_rows(M)])
    put("part.bdf", ["GRID,11,,0.,0.,0.5", "GRID,12,,1.5,0.,0."])


def stored(path, name):
    with h5py.File(path) as file:
        group = file[name]
        return scipy.sparse.csc_matrix(
            (group["data"][:], group["indices"][:], group["indptr"][:]),
            shape=group.attrs["shape"]).toarray()


def import_named():
    text = section("import.md", "Abaqus and CalculiX: matrices that name their "
                   "rows")
    commands = re.findall(r"^    (ritz-import .*)$", text, re.M)
    check(len(commands) == 2, "the page has a command for each format")
    write_named()
    for command in commands:
        status, said = tool(*command.split())
        check(status == 0 and "rows named by  file" in said, command, said)
        check(numpy.array_equal(stored("part.h5", "K"), K) and
              numpy.array_equal(stored("part.h5", "M"), M),
              "and the component has all bits")
        os.remove("part.h5")
    status, said = tool("ritz-info", "part.mtx")
    check(status == 0 and "STIFFNESS" in said and "MASS" in said,
          "the matrices of a substructure are listed", said)
    put("part.mtx", ["*USER ELEMENT, NODES=1, LINEAR", "** ELEMENT NODES",
                     "** 5", "1, 8", "*MATRIX,TYPE=MASS", "1.", "0., 1."])
    status, said = tool("ritz-import", "--mass", "part.mtx", "-o", "none.h5")
    check(status == 1 and "'part.mtx': line 4: degree of freedom 8, a pressure"
          in said and not os.path.exists("none.h5"), "a pressure is refused",
          said)


# CalculiX writes beyond its memory if it keeps more dofs than there are nodes.
BAR_NODES = {4 * k + c + 1: (2.0 * k, y, z) for k in range(21)
             for c, (y, z) in enumerate([(0.0, 0.0), (1.0, 0.0), (1.0, 1.5),
                                         (0.0, 1.5)])}
BAR = "\n".join([
    "*NODE, NSET=NALL",
    *(f"{node}, {x}, {y}, {z}" for node, (x, y, z) in BAR_NODES.items()),
    "*NSET, NSET=KEPT", "1, 2, 3, 4, 81, 82, 83, 84",
    "*ELEMENT, TYPE=C3D8, ELSET=EALL",
    *(", ".join(str(n) for n in (k, *range(4 * k - 3, 4 * k + 5)))
      for k in range(1, 21)),
    "*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3",
    "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL", ""])


def read_calculix(path):
    """Names of rows and the matrix, by the Fortran formats alone."""
    head, numbers = pathlib.Path(path).read_text(encoding="utf-8").split(
        "*MATRIX,TYPE=STIFFNESS\n")
    node = [int(word) for line in re.findall(r"^\*\*([ \d,]+)$", head, re.M)
            for word in line.split(",") if word.strip()]
    direction = [int(line.split(",")[-1]) for line in head.splitlines()
                 if not line.startswith("*")]
    A = numpy.zeros((len(node), len(node)))
    A[numpy.tril_indices(len(node))] = [
        float(word) for word in numbers.split(",") if word.strip()]
    return list(zip(node, direction)), A + numpy.tril(A, -1).T


def import_of_calculix():
    """The step of the page for a bar of twenty elements whose ends are kept."""
    if not shutil.which("ccx"):
        print("# skipped: no CalculiX")
        return
    text = section("import.md", "Abaqus and CalculiX: matrices that name their "
                   "rows")
    step = blocks(text, "")[2]
    pathlib.Path("bar.inp").write_text(BAR + step, encoding="utf-8")
    status, said = run("ccx", "bar")
    check(status == 0, "CalculiX writes a substructure", said)
    status, said = tool("ritz-import", "--stiffness", "part.mtx", "--mass",
                        "part.mtx", "-o", "bar.h5")
    check(status == 0 and "rows named by  file" in said, "it is imported", said)
    names, A = read_calculix("part.mtx")
    order = sorted(range(len(names)), key=lambda k: names[k])
    with h5py.File("bar.h5") as file:
        rows = list(zip(file["dofs/grid"][:], file["dofs/component"][:]))
    check(len(rows) == 24 and rows == [names[k] for k in order] and
          numpy.array_equal(stored("bar.h5", "K"), A[numpy.ix_(order, order)]),
          "and the component has all bits")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write_component()
        drop_members()
        change_types()
        scipy.io.mmwrite("M.mtx", scipy.sparse.csc_matrix(M))
        write_samples()
        known = {recognise(path) for path in (
            "header.mtx", "part.dof", "file.full", "nodes.txt")}
        text = section("import.md", "Files that are recognised and not read")
        listed = set(re.findall(r"^\| (an? [^|]+) \|", text, re.M))
        check(known == listed, "the page lists what is recognised",
              known ^ listed)
        convert()
        convert_external()
        import_named()
        import_of_calculix()
        os.chdir("/")
    print(f"1..{check.count}")


main()
