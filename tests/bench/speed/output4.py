"""Write sparse matrices as NASTRAN OUTPUT4 files, binary or text.

The columns are stored in the form "bigmat", which a negative number of rows in
the header marks. A column is a record: its number, zero, its length in words of
four bytes, then its strings. A string is a run of consecutive rows: its length
in words + 1, its first row, the values.
"""
import numpy

SYMMETRIC, REAL_DOUBLE = 6, 2
COLUMNS_AT_ONCE = 50000


def strings(A):
    """Index of the first entry of each string, and of the first string of each
    column."""
    begins = numpy.ones(A.nnz, bool)
    begins[1:] = numpy.diff(A.indices) != 1
    begins[A.indptr[:-1]] = True  # every column of K and M has a diagonal
    first = numpy.flatnonzero(begins)
    return first, numpy.searchsorted(first, A.indptr)


def pack_columns(A, number):
    """Records of the columns of A, numbered from `number` on."""
    first, of_column = strings(A)
    length = numpy.diff(numpy.r_[first, A.nnz])
    column = numpy.repeat(numpy.arange(A.shape[1]), numpy.diff(of_column))
    # a record has two marks, three words of its header, and its strings
    words = 2 * numpy.diff(A.indptr) + 2 * numpy.diff(of_column)
    start = numpy.r_[0, numpy.cumsum(words + 5)]
    out = numpy.empty(start[-1], "<i4")
    out[start[:-1]] = out[start[1:] - 1] = 4 * (words + 3)
    out[start[:-1] + 1] = number + numpy.arange(A.shape[1])
    out[start[:-1] + 2] = 0
    out[start[:-1] + 3] = words
    # words before a string: headers of all columns and strings up to it
    head = (2 * first + 2 * numpy.arange(len(first))
            + 5 * column + 4)
    out[head], out[head + 1] = 2 * length + 1, A.indices[first] + 1
    at = (numpy.repeat(head + 2, length)
          + 2 * (numpy.arange(A.nnz) - numpy.repeat(first, length)))
    value = numpy.ascontiguousarray(A.data, "<f8").view("<i4")
    out[at], out[at + 1] = value[::2], value[1::2]
    return out


def write(path, **matrices):
    """Write a binary file of the matrices {name: A}."""
    with open(path, "wb") as file:
        def record(*parts):
            body = b"".join(parts)
            mark = numpy.array([len(body)], "<i4").tobytes()
            file.write(mark + body + mark)

        for name, A in matrices.items():
            A = A.tocsc()
            A.sort_indices()
            rows, columns = A.shape
            record(numpy.array([columns, -rows, SYMMETRIC, REAL_DOUBLE],
                               "<i4").tobytes(), name.ljust(8).encode())
            for first in range(0, columns, COLUMNS_AT_ONCE):
                pack_columns(A[:, first:first + COLUMNS_AT_ONCE],
                             first + 1).tofile(file)
            record(numpy.array([columns + 1, 1, 2], "<i4").tobytes(),
                   numpy.array([1.0]).tobytes())


def write_text(path, **matrices):
    """Write a text file, 17 digits, three values a line."""
    with open(path, "w", encoding="ascii") as file:
        for name, A in matrices.items():
            A = A.tocsc()
            A.sort_indices()
            file.write(f"{A.shape[1]:8d}{-A.shape[0]:8d}{SYMMETRIC:8d}"
                       f"{REAL_DOUBLE:8d}{name:8}1P,3E23.16\n")
            first, of_column = strings(A)
            last = numpy.r_[first[1:], A.nnz]
            text = [f"{value:23.16E}" for value in A.data]
            for c in range(A.shape[1]):
                s = range(of_column[c], of_column[c + 1])
                words = 2 * (A.indptr[c + 1] - A.indptr[c]) + 2 * len(s)
                file.write(f"{c + 1:8d}{0:8d}{words:8d}\n")
                for k in s:
                    file.write(f"{2 * (last[k] - first[k]) + 1:8d}"
                               f"{A.indices[first[k]] + 1:8d}\n")
                    for e in range(first[k], last[k], 3):
                        file.write("".join(text[e:min(e + 3, last[k])])
                                   + "\n")
            file.write(f"{A.shape[1] + 1:8d}{1:8d}{2:8d}\n{1.0:23.16E}\n")
