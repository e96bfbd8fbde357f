"""Makes HDF5 files without checksums for walker.sh, sound and damaged ones.

Usage: walker.py make           write old.mat, old.h5 (from new.h5), and files
                                that make their reader crash, hang or run out of
                                memory
       walker.py damage COUNT   run ritz-info, which is on the PATH, on COUNT
                                damaged copies of old.mat and of old.h5
"""
import concurrent.futures
import os
import random
import struct
import subprocess
import sys

import h5py
import numpy

LIMIT = 60.0  # seconds


def begin(path):
    return h5py.File(path, "w", libver="earliest", userblock_size=512)


def end(path):
    """Write the head of a MAT file; return all bytes of the file."""
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file")
        file.seek(0)
        return bytearray(file.read())


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def node(data, kind):
    """Position of the first B-tree node of a kind (0: groups, 1: chunks)."""
    at = data.index(b"TREE")
    while data[at + 4] != kind:
        at = data.index(b"TREE", at + 1)
    return at


def small(path):
    """A small file of two matrices, whose parts are easy to find."""
    with begin(path) as f:
        f["K"] = numpy.eye(2)
        f.create_dataset("M", data=numpy.eye(4), chunks=(2, 4),
                         compression="gzip")
    return end(path)


def make_hostile():
    data = small("own_child.mat")
    at = node(data, 0)
    data[at + 5] = 1  # level 1: its children are nodes, here itself
    struct.pack_into("<Q", data, at + 32, at - 512)
    write("own_child.mat", data)

    data = small("own_sibling.mat")
    at = node(data, 0)
    struct.pack_into("<Q", data, at + 16, at - 512)
    write("own_sibling.mat", data)

    data = small("large_chunk.mat")
    at = node(data, 1)
    struct.pack_into("<I", data, at + 24, 0xf0000000)  # size of the first chunk
    write("large_chunk.mat", data)

    with begin("own_member.mat") as f:
        f["K"] = numpy.eye(2)
        f["s/K"] = numpy.eye(2)
        f["s/s"] = f["s"]
        f["s/up"] = f["/"]
    end("own_member.mat")


def make_sound():
    with begin("old.mat") as f:
        f.create_dataset("K", data=numpy.eye(6), chunks=(2, 6), shuffle=True,
                         compression="gzip", fletcher32=True)
        f["M"] = numpy.eye(6)
        f["Z"] = numpy.ones((2, 2), [("real", "f8"), ("imag", "f8")])
        f["narrow"] = numpy.ones((3, 3), "i2")
        f["single"] = numpy.ones((3, 3), "f4")
        f["M"].attrs["MATLAB_class"] = numpy.bytes_("double")
        s = f.create_group("S")
        s.attrs["MATLAB_sparse"] = numpy.uint64(2)
        s["ir"], s["jc"] = numpy.arange(2, dtype="u8"), numpy.arange(3, dtype="u8")
        s["data"] = numpy.ones(2)
        f["t/A"] = numpy.eye(2)
    end("old.mat")
    with h5py.File("new.h5") as new, \
            h5py.File("old.h5", "w", libver="earliest") as old:
        old.attrs.update(new.attrs)
        for name in new:
            new.copy(name, old)


def spoil(data, seed):
    """Change random bytes and words, but not within long runs of zeros."""
    rng = random.Random(seed)
    out = bytearray(data)
    words = (b"\xff" * 8, b"\0" * 8, b"\xff" * 7 + b"\x7f", b"\0" * 7 + b"\x80",
             b"\0\0\0\x40\0\0\0\0", b"\0\0\0\xf0\0\0\0\0")
    places = [k for k in range(len(data)) if any(data[max(0, k - 8):k + 8])]
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        at = rng.choice(places)
        if rng.random() < 0.4:
            out[at & ~7:(at & ~7) + 8] = rng.choice(words)
        else:
            out[at] = rng.choice((0, 1, 2, 3, 127, 128, 254, 255,
                                  rng.randrange(256)))
    return bytes(out[:len(data)])


def prepare_sanitizers():
    """On damaged files HDF5 leaks, and copies bytes beyond the end of a block.
    Neither ends the process; these settings ignore both, and leave the checks
    of Ritz's own code as they are."""
    leaks = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..",
                         "unit", "hdf5.supp")
    os.environ["LSAN_OPTIONS"] = f"suppressions={leaks}:print_suppressions=0"
    os.environ["ASAN_OPTIONS"] = ":".join(filter(None, (
        os.environ.get("ASAN_OPTIONS"), "replace_intrin=0:replace_str=0")))


def judge(path):
    """Run ritz-info; return what is wrong with the run, or None."""
    try:
        run = subprocess.run(["ritz-info", path], capture_output=True,
                             timeout=LIMIT, text=True, errors="replace")
    except subprocess.TimeoutExpired:
        return f"still running after {LIMIT} s"
    sentences = run.stderr.splitlines()
    if run.returncode not in (0, 1):
        return f"status {run.returncode}: {sentences[:3]}"
    if run.returncode == 1 and len(sentences) != 1:
        return f"{len(sentences)} sentences: {sentences[:3]}"
    return None


def meet(name, seed):
    stem, ending = os.path.splitext(name)
    path = f"{stem}-{seed}{ending}"
    with open(name, "rb") as file:
        write(path, spoil(file.read(), seed))
    wrong = judge(path)
    os.remove(path)
    return wrong and f"{name}, seed {seed}: {wrong}"


def damage(count):
    prepare_sanitizers()
    pairs = [(name, seed) for seed in range(count)
             for name in ("old.mat", "old.h5")]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = list(filter(None, pool.map(lambda pair: meet(*pair), pairs)))
    print(*wrong, sep="\n")
    sys.exit(1 if wrong else 0)


if sys.argv[1] == "make":
    make_sound()
    make_hostile()
else:
    damage(int(sys.argv[2]))
