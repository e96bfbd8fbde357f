"""The rules of the house that a script can hold; the rest is in
docs/contributing.md, for people. Run by tests/house.sh.

Each rule yields sentences of the form "FILE: what is wrong". The graph is made
from the text: a file depends on another if it names a function or a table
that the other alone defines.
"""

import os
import re
import sys

# Rooms by level: a room may use those of lower levels, and itself.
LEVELS = [
    ['base'],
    ['linear'],
    ['model'],
    ['container', 'gramians'],
    ['bases', 'ranking', 'poles'],
    ['scene'],
    ['response', 'check'],
    ['verify', 'simulate'],
    ['estimate'],
    ['assembly'],
    ['compare'],
    ['fit'],
    ['formats'],
    ['import'],
    ['cli'],
    ['print', 'claims'],
    ['chart'],
    ['tools', 'libexec'],
    ['fmu'],
]
LEVEL = {room: k for k, rooms in enumerate(LEVELS) for room in rooms}

# The program inside FMUs: it is linked with nothing of ours, and nothing of
# ours with it.
ALONE = 'fmu'

# Files of others, kept as their authors wrote them.
FOREIGN = ('fmu/fmi',)

# Files that define one table, and the table's name.
TABLES = {
    'src/bases/bases.c': 'ritz_methods',
    'src/ranking/rankers.c': 'ritz_rankers',
    'src/response/engines.c': 'ritz_response_engines',
    'src/verify/measures.c': 'ritz_measure_table',
    'src/simulate/integrators.c': 'ritz_integrators',
    'src/check/checks.c': 'ritz_checks',
    'formats/formats.c': 'ritz_formats',
    'formats/decks.c': 'ritz_decks',
    'formats/exporters.c': 'ritz_exporters',
    'formats/histories.c': 'ritz_history_formats',
    'formats/series_formats.c': 'ritz_series_formats',
    'tools/chart/charts.c': 'chart_kinds',
}

HOME = 'src/base/tolerances.h'
WORD = re.compile(r'[A-Za-z_]\w*')


def room_of(path):
    parts = path.split('/')
    if parts[0] == 'src':
        return parts[1]
    if parts[0] == 'tools':
        return parts[1] if len(parts) > 2 else 'tools'
    return parts[0]


def bare(text):
    """Text without comments and strings, with its lines kept."""
    def blank(match):
        return re.sub(r'[^\n]', ' ', match.group(0))
    return re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\])*\'',
                  blank, text, flags=re.S)


def read_tree(root):
    files = {}
    for top in ('include', 'src', 'formats', 'tools', 'libexec', 'fmu'):
        for folder, _, names in os.walk(os.path.join(root, top)):
            if os.path.relpath(folder, root) in FOREIGN:
                continue
            for name in names:
                if name.endswith(('.c', '.h')):
                    path = os.path.join(folder, name)
                    with open(path, encoding='utf-8') as file:
                        files[os.path.relpath(path, root)] = file.read()
    return files


FUNCTION = re.compile(r'^(?!static|typedef|return|else)[A-Za-z_][\w \*]*?'
                      r'[ \*](\w+)\(([^;{}]*)\)\s*\{', re.M)
TABLE = re.compile(r'^const [\w ]+?[ \*](\w+)(?:\[\w*\])* =', re.M)


OWN = re.compile(r'^static [\w \*]*?[ \*](\w+)\(', re.M)


def definitions(code):
    """Names that other files can use, to the file that defines them."""
    home = {}
    for path, text in code.items():
        if path.endswith('.c'):
            for match in FUNCTION.finditer(text):
                home.setdefault(match.group(1), set()).add(path)
            for match in TABLE.finditer(text):
                home.setdefault(match.group(1), set()).add(path)
    return {name: min(paths) for name, paths in home.items()
            if len(paths) == 1}


def uses(code, home):
    """(user, definer) to the names used."""
    graph = {}
    for path, text in code.items():
        if path.endswith('.c'):
            own = set(OWN.findall(text))
            for name in set(WORD.findall(text)) - own:
                there = home.get(name)
                if there and there != path:
                    graph.setdefault((path, there), []).append(name)
    return graph


def rooms_are_ordered(files, code, graph):
    for path in files:
        if not path.startswith('include') and room_of(path) not in LEVEL:
            yield f"{path}: the room '{room_of(path)}' is not in LEVELS"
    for path, there, name in includes(files):
        if above(path, there):
            yield f'{path}: includes {name}, of a room above its own'
    for (path, there), names in sorted(graph.items()):
        if above(path, there):
            yield f'{path}: uses {min(names)} of {there}, a room above its own'


def includes(files):
    """Files with the file that each of their #include names, of the tree."""
    for path, text in files.items():
        if path.startswith('include'):
            continue
        beside = os.path.dirname(path) + '/'
        for name in re.findall(r'#include ["<]([^">]+)[">]', text):
            there = next((p for p in ('src/' + name, name, 'tools/' + name,
                                      'include/' + name, beside + name)
                          if p in files), None)
            if there:
                yield path, there, name


def the_program_of_fmus_is_alone(files, code, graph):
    used = [(path, there, name) for path, there, name in includes(files)]
    used += [(path, there, min(names)) for (path, there), names
             in sorted(graph.items())]
    for path, there, name in used:
        if (room_of(path) == ALONE) != (room_of(there) == ALONE):
            yield f'{path}: uses {name} of {there}: {ALONE}/ is alone'


def above(path, there):
    mine, other = room_of(path), room_of(there)
    return mine != other and LEVEL.get(other, -1) >= LEVEL.get(mine, 0)


def files_form_no_circle(files, code, graph):
    after = {}
    for user, definer in graph:
        after.setdefault(user, set()).add(definer)
    for circle in circles(after):
        yield ' -> '.join(sorted(circle)) + ': a circle of files'


def circles(after):
    """Strongly connected components of two files or more [Tarjan1972]."""
    index, low, stack, on, found = {}, {}, [], set(), []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        on.add(node)
        for other in sorted(after.get(node, ())):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in on:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            circle = []
            while True:
                other = stack.pop()
                on.discard(other)
                circle.append(other)
                if other == node:
                    break
            if len(circle) > 1:
                found.append(circle)

    sys.setrecursionlimit(10000)
    for node in sorted(after):
        if node not in index:
            visit(node)
    return found


def tables_hold_a_table(files, code, graph):
    for path, table in TABLES.items():
        if path not in code:
            yield f'{path}: is not there, but should define {table}'
            continue
        if not re.search(r'\b' + table + r'\b', code[path]):
            yield f'{path}: does not define {table}'
        for match in re.finditer(r'^(?!const )[a-z][\w \*]*?[ \*](\w+)\(',
                                 code[path], re.M):
            yield f'{path}: holds {match.group(1)} beside its table'


# What decides a comparison is small: 1e-9, 0x1p-40, 2.2e-16. A formula of a
# paper may hold one beside its key.
SMALL = re.compile(r'(?<![\w.])(?:\d+\.?\d*|\.\d+)[eE]-\d+|0x[\da-fA-F.]+p-\d+')
FILE_CONSTANT = re.compile(r'^static const double \w+ =', re.M)


def tolerances_are_at_home(files, code, graph):
    for path, text in code.items():
        if path == HOME or not path.startswith(('src', 'formats', 'fmu')):
            continue
        lines = files[path].split('\n')
        for number, line in enumerate(text.split('\n')):
            near = ' '.join(lines[max(0, number - 3):number + 1])
            if re.search(r'\[[A-Z][A-Za-z]+\d{4}', near):
                continue
            if SMALL.search(line) or FILE_CONSTANT.search(line):
                yield (f'{path}:{number + 1}: a tolerance outside of {HOME}:'
                       f'{line}')


def types_have_one_meaning(files, code, graph):
    where = {}
    for path, text in code.items():
        for match in re.finditer(r'^typedef [^;{]*?(\w+);|^\} ?(\w+);', text,
                                 re.M):
            name = match.group(1) or match.group(2)
            where.setdefault(name, set()).add(path)
    for name, paths in sorted(where.items()):
        if len(paths) > 1:
            yield f"{', '.join(sorted(paths))}: the type {name} is defined twice"


# Functions that a program finds with one BLAS only.
ONE_BLAS = re.compile(r'\b(?:openblas|mkl|bli)_\w+')
BLAS_HOME = 'src/linear/blas_threads.c'


def any_blas_will_do(files, code, graph):
    for path, text in code.items():
        for name in sorted(set(ONE_BLAS.findall(text))):
            if path != BLAS_HOME:
                yield (f'{path}: calls {name}, which other BLAS libraries do '
                       f'not have: only {BLAS_HOME} may')


RULES = [rooms_are_ordered, the_program_of_fmus_is_alone, files_form_no_circle,
         tables_hold_a_table, tolerances_are_at_home, types_have_one_meaning,
         any_blas_will_do]


def main(root):
    files = read_tree(root)
    code = {path: bare(text) for path, text in files.items()}
    graph = uses(code, definitions(code))
    failed = False
    print(f'1..{len(RULES)}')
    for number, rule in enumerate(RULES, 1):
        wrong = list(rule(files, code, graph))
        name = rule.__name__.replace('_', ' ')
        print(f"{'not ok' if wrong else 'ok'} {number} - {name}")
        for sentence in wrong:
            print('# ' + sentence)
        failed = failed or bool(wrong)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else '.'))
