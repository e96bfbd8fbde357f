"""docs/failures/README.md: a row and a section for each case, and pictures."""
import re
import subprocess

from failure import HERE, NUMBER, names

DOCS = HERE.parents[1] / "docs" / "failures"
CLOSE = 0.05  # two digits

GROUPS = ("Modes", "Matrices as they come", "Interfaces and bases",
          "Damping and responses", "Rankings",
          "Reduced models that are unstable", "Joints that turn",
          "Runs over time")

HEAD = """\
# Where methods fail, and what Ritz does

Each row is a case that `./bootstrap check` runs: a model on which a program written in the usual way answers wrongly, often without a word, and what Ritz answers.
`tests/failures/cases` holds one file a case, with the naive program in it. A case holds both sides: the naive answer must be wrong by a stated amount, Ritz's right to a stated one, or refused in the words shown. This page is written by

    tests/failures/run build/release/bin --page docs/failures

and each case is held to its row here, numbers to two digits. Commands are as the cases run them; `tests/failures/models.py` makes the models. [What Ritz does not catch](not-caught.md) has a page of its own.

"""

TABLE = """\
### {}

| case | naive answer | right | Ritz |
|---|---|---|---|
"""


def title(it):
    return it.story.strip().split("\n")[0]


def anchor(it):
    """As Markdown makes it of a heading."""
    words = re.sub(r"[^\w\- ]", "", title(it).lower())
    return words.replace(" ", "-")


def row(it):
    cells = [it.cells[key] for key in ("naive", "right", "ritz")]
    return " | ".join([f"| [{title(it)}](#{anchor(it)})", *cells]) + " |"


def drawn(it):
    """Names of the pictures of a case."""
    count = len(it.pictures)
    return [f"{it.name}{'' if count == 1 else f'-{k + 1}'}.svg"
            for k in range(count)]


def section(it):
    body = "\n".join(it.story.strip().split("\n")[1:]).strip()
    text = [f"## {title(it)}", body]
    if it.commands:
        text.append("\n".join("    " + line for line in it.commands))
    for name, (_, caption, _) in zip(drawn(it), it.pictures):
        text.append(f"![{caption}]({name})")
        text.append(f"*{caption}*")
    text.append(f"Case: `tests/failures/cases/"
                f"{it.name.replace('-', '_')}.py`.")
    return "\n\n".join(text)


def draw(it, folder):
    """gnuplot: the same bytes for the same numbers."""
    for name, (script, _, data) in zip(drawn(it), it.pictures):
        lines = ["set encoding utf8",
                 'set terminal svg size 640,320 dynamic font "Helvetica,13" '
                 'background rgb "white" linewidth 1.2',
                 f'set output "{folder / name}"',
                 'set grid lc rgb "#dddddd" lt 1', 'unset mxtics',
                 'unset mytics']
        for block, columns in data.items():
            lines.append(f"${block} << END")
            lines += [" ".join(f"{value:.5g}" for value in line)
                      for line in zip(*columns)]
            lines.append("END")
        subprocess.run(["gnuplot", "-d"], input="\n".join(lines + [script, ""]),
                       text=True, check=True)
        slim(folder / name)


def slim(path):
    """Without empty groups and blanks, which are half of what gnuplot writes."""
    text = path.read_text()
    before = None
    while before != text:
        before, text = text, re.sub(r"<g\b[^>]*>\s*</g>", "", text)
    text = re.sub(r"<desc>.*</desc>|<tspan[^>]*></tspan>", "", text)
    text = re.sub(r'(<tspan) font-family="Helvetica"', r"\1", text)
    path.write_text(re.sub(r"\s*\n\s*", "\n", text))


def write(cases, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for it in cases:
        draw(it, folder)
    ordered = [(group, [it for it in cases if it.group == group])
               for group in GROUPS]
    tables = "\n\n".join(TABLE.format(group) + "\n".join(map(row, members))
                         for group, members in ordered)
    sections = "\n\n".join(section(it) for _, members in ordered
                           for it in members)
    (folder / "README.md").write_text(HEAD + tables + "\n\n" + sections + "\n")


def same(a, b):
    """Texts but for the last digits of their numbers."""
    if NUMBER.split(a) != NUMBER.split(b):
        return False
    pairs = zip(map(float, NUMBER.findall(a)), map(float, NUMBER.findall(b)))
    return all(abs(x - y) <= CLOSE * max(abs(x), abs(y)) for x, y in pairs)


def differs(it, folder=DOCS):
    """What the page says of a case that is not so any more; None: nothing."""
    path = folder / "README.md"
    if not path.exists():
        return f"there is no {path}"
    lines = path.read_text().split("\n")
    start = f"| [{title(it)}]("
    found = [line for line in lines if line.startswith(start)]
    if not found:
        return f"{path.name} has no row '{title(it)}': run with --page"
    if not same(found[0], row(it)):
        return (f"{path.name} says '{found[0]}', the case '{row(it)}': run "
                "with --page")
    missing = [name for name in drawn(it) if not (folder / name).exists()]
    return f"no picture {missing[0]}" if missing else None


def strays(folder=DOCS):
    """Rows without a case, pictures without a row; what is there to say."""
    text = (folder / "README.md").read_text()
    rows = sum(line.startswith("| [") for line in text.split("\n"))
    if rows != len(names()):
        return f"{rows} rows for {len(names())} cases: run with --page"
    unseen = [path.name for path in folder.glob("*.svg")
              if f"({path.name})" not in text]
    return f"no row shows {unseen[0]}" if unseen else None
