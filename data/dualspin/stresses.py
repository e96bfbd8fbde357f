#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Stresses of the bars and rods of a deck of this folder, as rows of y = S u.

usage: stresses.py DECK STIFFNESS-ROWS.mtx NAMES.txt

A bar has eight rows, its axial stress with that of bending, at both ends (a, b)
and on both sides of both planes; a rod has one. PBAR gives areas and moments of
inertia and no outline: stresses are those of thin-walled tubes with the same,
whose radius c in a plane is sqrt(2 I / A).

    N = E A (u_b - u_a) / L,   sigma = N / A +- M c / I

with M from the stiffness of an Euler-Bernoulli beam. Columns are the rows of the
matrices that NASTRAN made: six for each grid, ascending, along displacement
axes.
"""

import math
import re
import sys


def number(text):
    """A number of NASTRAN, '1.-5' for 1e-5."""
    return float(re.sub(r'(?<=[\d.])([+-]\d)', r'e\1', text.strip()) or 0.0)


def cards(path):
    """Cards of eight columns a field; continuations are joined."""
    found = []
    with open(path, encoding='ascii') as file:
        for line in file:
            line = line.rstrip('\n').ljust(80)
            if line[0] == '$':
                continue
            fields = [line[k:k + 8].strip() for k in range(8, 72, 8)]
            if line[0] == '+':
                found[-1][1].extend(fields)
            elif line[:8].strip():
                found.append((line[:8].strip(), fields))
    return found


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def frame_of(fields):
    """Origin and axes of a CORD2R or CORD2C that refers to the basic frame."""
    value = [number(f) for f in fields[2:11]]
    origin, on_z, in_xz = value[:3], value[3:6], value[6:9]
    z = unit(minus(on_z, origin))
    y = unit(cross(z, minus(in_xz, origin)))
    return origin, [cross(y, z), y, z]


def placed(frame, kind, x):
    if kind == 'CORD2C':
        angle = math.radians(x[1])
        x = [x[0] * math.cos(angle), x[0] * math.sin(angle), x[2]]
    origin, axes = frame
    return [origin[i] + sum(x[k] * axes[k][i] for k in range(3))
            for i in range(3)]


class Deck:
    def __init__(self, path):
        all_cards = cards(path)
        basic = ([0.0] * 3, [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]])
        frames = {0: (basic, 'CORD2R')}
        for name, f in all_cards:
            if name in ('CORD2R', 'CORD2C'):
                frames[int(f[0])] = (frame_of(f), name)
        self.grid, self.axes, self.young = {}, {}, {}
        self.section, self.elements = {}, []
        for name, f in all_cards:
            if name == 'GRID':
                frame, kind = frames[int(f[1] or 0)]
                self.grid[int(f[0])] = placed(frame, kind,
                                              [number(x) for x in f[2:5]])
                self.axes[int(f[0])] = frames[int(f[5] or 0)][0][1]
            elif name == 'MAT1':
                self.young[int(f[0])] = number(f[1])
            elif name in ('PBAR', 'PROD'):
                self.section[int(f[0])] = (int(f[1]),
                                           [number(x) for x in f[2:5]])
            elif name in ('CBAR', 'CROD'):
                self.elements.append((name, f))
        self.first = {g: 6 * k for k, g in enumerate(sorted(self.grid))}

    def along(self, grid, direction, turn):
        """Row vector of the motion of a grid along a basic direction."""
        at = self.first[grid] + (3 if turn else 0)
        return {at + k: dot(self.axes[grid][k], direction) for k in range(3)}


def combine(*terms):
    row = {}
    for factor, vector in terms:
        for column, value in vector.items():
            row[column] = row.get(column, 0.0) + factor * value
    return row


def bending(deck, a, b, x, side, length):
    """Curvatures at both ends in the plane of x and `side`, as row vectors."""
    about = cross(x, side)
    v = [deck.along(g, side, False) for g in (a, b)]
    turn = [deck.along(g, about, True) for g in (a, b)]
    chord = combine((1.0 / length, v[1]), (-1.0 / length, v[0]))
    return (combine((6.0 / length, chord), (-4.0 / length, turn[0]),
                    (-2.0 / length, turn[1])),
            combine((-6.0 / length, chord), (2.0 / length, turn[0]),
                    (4.0 / length, turn[1])))


def rows_of(deck, name, f):
    """(word, row vector) of each stress of an element."""
    a, b = int(f[2]), int(f[3])
    material, (area, *inertia) = deck.section[int(f[1])]
    young = deck.young[material]
    between = minus(deck.grid[b], deck.grid[a])
    length = math.sqrt(dot(between, between))
    x = unit(between)
    axial = combine((young / length, deck.along(b, x, False)),
                    (-young / length, deck.along(a, x, False)))
    if name == 'CROD':
        return [('axial', axial)]
    v = [sum(number(f[4 + k]) * deck.axes[a][k][i] for k in range(3))
         for i in range(3)]
    z = unit(cross(x, v))
    y = cross(z, x)
    rows = []
    for plane, side in ((1, y), (2, z)):
        fibre = math.sqrt(2.0 * inertia[plane - 1] / area)
        ends = bending(deck, a, b, x, side, length)
        for end, curvature in zip('ab', ends):
            for sign, word in ((1.0, '+'), (-1.0, '-')):
                rows.append((f'{end}{plane}{word}',
                             combine((1.0, axial),
                                     (-sign * young * fibre, curvature))))
    return rows


def main(path, matrix, names):
    deck = Deck(path)
    entries, lines = [], []
    for name, f in deck.elements:
        for word, row in rows_of(deck, name, f):
            lines.append(f'{f[0]} {word}')
            entries += [(len(lines), column + 1, value)
                        for column, value in sorted(row.items()) if value]
    with open(matrix, 'w', encoding='ascii') as file:
        file.write('%%MatrixMarket matrix coordinate real general\n'
                   f'% stresses of {path}: rows of y = S u, in N/m^2\n'
                   f'{len(lines)} {6 * len(deck.grid)} {len(entries)}\n')
        file.writelines(f'{i} {j} {v:.17g}\n' for i, j, v in entries)
    with open(names, 'w', encoding='ascii') as file:
        file.write('# element, end and plane and side of the bar\n')
        file.writelines(line + '\n' for line in lines)


if __name__ == '__main__':
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
