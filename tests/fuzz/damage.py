"""Damaged files through the tools, as damage.sh prepares them.

Usage: damage.py FOLDER SEEDS, the tools being on the PATH.

FOLDER/cases has one case a line: which file is damaged, then the command, in
which '@' is that file and OUT the output. Each command gets the file cut
short, emptied, replaced and, SEEDS times, randomly spoiled; it must end with
status 0, or with 1 and one sentence and no output; never with a signal or a
report of a sanitizer, nor late, nor with a file left over. One TAP line for
each case and kind of damage, so that a failure says where to look; the damaged
file is kept beside FOLDER.
"""
import concurrent.futures
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys

LIMIT = 60.0  # seconds; measured: the slowest took 2 with an idle core
MEGABYTES = 1024  # of one allocation, none of these models needs 10

NUMBER = re.compile(rb"-?[0-9]+(\.[0-9]*)?([eEdD][-+]?[0-9]+)?")
NUMBERS = (b"99999999999999999999", b"2147483647", b"9223372036854775807",
           b"-1", b"0", b"1e999", b"nan", b"1.5", b"", b"1+400")
WORDS = (b"\xff" * 8, b"\xff" * 7 + b"\x7f", b"\x00" * 8, b"\x00" * 7 + b"\x80",
         b"\x00\x00\x00\x40\x00\x00\x00\x00", b"\x00" * 6 + b"\xf0\x7f")


def flip(data, rng):
    """One bit in each of a few places."""
    out = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8, 64))):
        out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    return bytes(out)


def cut(data, rng):
    return data[:rng.randrange(len(data))]


def drop(data, rng):
    """A piece of the middle is gone."""
    at = rng.randrange(len(data))
    return data[:at] + data[at + rng.randint(1, 200):]


def repeat(data, rng):
    """A piece stands there twice."""
    at = rng.randrange(len(data))
    return data[:at + rng.randint(1, 200)] + data[at:]


def noise(data, rng):
    """Binary garbage over a piece."""
    at = rng.randrange(len(data))
    garbage = rng.randbytes(rng.randint(1, 64))
    return data[:at] + garbage + data[at + len(garbage):]


def declare(data, rng):
    """Another number where one stood: sizes, counts, values."""
    if b"\0" in data:
        at = rng.randrange(0, len(data), 4)
        word = rng.choice(WORDS)
        return data[:at] + word + data[at + len(word):]
    found = rng.choice(list(NUMBER.finditer(data)))
    return data[:found.start()] + rng.choice(NUMBERS) + data[found.end():]


def swap(data, rng):
    """Two lines change places; pieces of a binary file."""
    lines = data.split(b"\n") if b"\0" not in data else [
        data[k:k + 64] for k in range(0, len(data), 64)]
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return (b"\n" if b"\0" not in data else b"").join(lines)


SPOILERS = (declare, flip, cut, drop, repeat, noise, swap)


def spoiled(data, seed):
    """The spoilers in turn, so that few seeds meet each of them."""
    rng = random.Random(seed)
    out = SPOILERS[seed % len(SPOILERS)](data, rng)
    while rng.random() < 0.2:
        out = rng.choice(SPOILERS)(out or b"0", rng)
    return out


def of_other_kinds(folder, name):
    """What is no such file at all: name, and how to make it."""
    other = "rotor.op4" if name.endswith(".h5") else "platform.h5"
    rng = random.Random(name)
    return (
        ("no file", lambda path: None),
        ("an empty file", lambda path: path.write_bytes(b"")),
        ("a folder", lambda path: path.mkdir()),
        ("/dev/null", lambda path: path.symlink_to("/dev/null")),
        ("garbage", lambda path: path.write_bytes(rng.randbytes(5000))),
        ("one line of 100000", lambda path: path.write_bytes(b"1 " * 50000)),
        ("a file of another kind",
         lambda path: shutil.copy(folder / other, path)),
    )


def judge(run, sentences, left, made):
    """What is wrong with a run, or None."""
    if run.returncode < 0:
        return f"ended by signal {-run.returncode}"
    if "Sanitizer" in run.stderr or "runtime error" in run.stderr:
        return "a sanitizer reports"
    if run.returncode not in (0, 1):
        return f"status {run.returncode}"
    if left:
        return f"left {left}"
    if run.returncode == 0:
        return f"says {sentences}" if sentences else None
    if made:
        return "failed and left an output"
    if len(sentences) != 1:
        return f"{len(sentences)} sentences"
    if not sentences[0].isprintable():
        return "a sentence that cannot be printed"
    return None


def meet(folder, command, name, make, number):
    """Run a command on what make puts in the place of the file name."""
    place = folder.parent / f"run-{number}"
    shutil.copytree(folder, place, symlinks=True)
    victim = place / name
    victim.unlink()
    make(victim)
    before = set(os.listdir(place)) | {name}
    words = [word.replace("@", name) for word in command]
    try:
        run = subprocess.run(words, cwd=place, capture_output=True,
                             timeout=LIMIT, text=True, errors="replace",
                             stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return f"still running after {LIMIT} s", place, words, ""
    after = set(os.listdir(place)) - before
    warning = f"{words[0]}: warning: "
    wrong = judge(run, [line for line in run.stderr.splitlines()
                        if not line.startswith(warning)],
                  after - {"OUT"}, "OUT" in after)
    if wrong is None:
        shutil.rmtree(place)
    return wrong, place, words, run.stderr


def main():
    folder, seeds = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    # an answer to a declared size that the file does not hold is a report
    os.environ["ASAN_OPTIONS"] = ":".join(filter(None, (
        os.environ.get("ASAN_OPTIONS"),
        f"exitcode=99:max_allocation_size_mb={MEGABYTES}")))
    # HDF5 itself loses a few bytes on a damaged file
    leaks = pathlib.Path(__file__).parent.parent / "unit" / "hdf5.supp"
    os.environ["LSAN_OPTIONS"] = (
        f"suppressions={leaks.resolve()}:print_suppressions=0")
    cases = [shlex.split(line) for line in (folder / "cases").read_text()
             .splitlines() if line and not line.startswith("#")]
    (folder / "cases").unlink()
    runs = []
    for name, *command in cases:
        data = (folder / name).read_bytes()
        for what, make in of_other_kinds(folder, name):
            runs.append((command, name, what, make))
        for seed in range(seeds):
            runs.append((
                command, name, f"spoiled, seed {seed}",
                lambda path, d=data, s=seed: path.write_bytes(spoiled(d, s))))
    bad = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        futures = [pool.submit(meet, folder, command, name, make, k)
                   for k, (command, name, what, make) in enumerate(runs)]
        for k, future in enumerate(futures):
            command, name, what, _ = runs[k]
            wrong, place, words, said = future.result()
            print(f"{'not ok' if wrong else 'ok'} {k + 1} - "
                  f"{words[0]}: {name} is {what}")
            if wrong:
                bad += 1
                print(f"# {wrong}: {' '.join(words)}, in {place}")
                print(*(f"# {line}" for line in said.splitlines()[:40]),
                      sep="\n")
    print(f"1..{len(runs)}")
    sys.exit(1 if bad else 0)


main()
