"""What the machine is, how fast it is, and which packages are installed."""
import datetime
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import time

from quality import Unknown

# threads of peers are set job by job; the tools choose theirs themselves
THREADS = re.compile(r"^(OMP|GOMP|KMP|OPENBLAS|GOTO|MKL)_")
LIBRARIES = ("libsuitesparse-dev", "libmumps-seq-dev", "libopenblas-openmp-dev",
             "slepc-dev", "petsc-dev", "python3-scipy", "octave",
             "calculix-ccx")


def environment(**more):
    """The environment of this process without variables that set threads."""
    kept = {name: value for name, value in os.environ.items()
            if not THREADS.match(name) and not name.startswith("RITZ_")}
    return kept | more


def said(*command):
    """The output of a command; empty if there is no such command."""
    try:
        return subprocess.run(command, capture_output=True, text=True,
                              check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text()
    name = re.search(r"^model name\s*:\s*(.*)$", text, re.M)
    flags = set(re.search(r"^flags\s*:\s*(.*)$", text, re.M)[1].split())
    bits = 512 if "avx512f" in flags else 256 if "avx2" in flags else 128
    return (name[1] if name else "unknown processor"), bits


def memory():
    """Bytes of physical memory."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def packages():
    """Versions of the Debian packages that are installed."""
    found = {}
    for name in LIBRARIES:
        version = said("dpkg-query", "-W", "-f", "${Version}", name)
        if version:
            found[name] = version
    return found


def busy():
    """Processor seconds that all processes used since the machine started, and
    those that its host gave to other machines."""
    words = pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()
    user, nice, system, _, _, interrupt, soft, steal = map(int, words[1:9])
    return (user + nice + system + interrupt + soft + steal) / os.sysconf(
        "SC_CLK_TCK")


class Others:
    """The fraction of the processors that other processes use meanwhile."""

    def __init__(self, stopwatch):
        self.stopwatch = stopwatch
        self.began, self.busy = time.monotonic(), busy() - self.own()

    def own(self):
        return self.stopwatch.cpu + sum(
            used.ru_utime + used.ru_stime for used in map(
                resource.getrusage,
                (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))

    def part(self):
        seconds = (time.monotonic() - self.began) * os.cpu_count()
        return max(busy() - self.own() - self.busy, 0.0) / seconds


def describe(root):
    name, bits = processor()
    return {"processor": name, "vector_bits": bits,
            "cores": len(os.sched_getaffinity(0)), "memory": memory(),
            "system": said("uname", "-sr"),
            "date": datetime.date.today().isoformat(),
            "commit": said("git", "-C", str(root), "describe", "--always",
                           "--dirty", "--abbrev=10"),
            "packages": packages()}


def limits(shop, cores):
    """Floating-point operations and bytes read a second, on one thread and on
    all cores."""
    try:
        program = shop.program("limits")
    except Unknown as reason:
        print(f"limits of the machine are not known: {reason}",
              file=sys.stderr)
        return {}
    return {str(n): json.loads(shop.stopwatch(
        program, environment(OMP_NUM_THREADS=str(n)), shop.folder)["out"])
        for n in sorted({1, cores})}
