#!/usr/bin/python3 -s
"""run.py SCRIPT PROGRAMS - run a script of this folder; if a package that it
imports is not there, it ends as one that was skipped, with the reason."""
import runpy
import sys

if len(sys.argv) != 3:
    sys.exit(__doc__)
sys.argv = sys.argv[1:]
try:
    runpy.run_path(sys.argv[0], run_name="__main__")
except ModuleNotFoundError as missing:
    print("skipped:", missing, flush=True)
    sys.exit(77)
