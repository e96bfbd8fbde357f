#!/usr/bin/python3 -s
"""with_page.py PROGRAMS - blocks in Python of docs/simulators.md run with the
programs for which they are written, on files that the page has made."""
import pathlib
import runpy

runpy.run_path(str(pathlib.Path(__file__).with_name("simulators.py")),
               run_name="__main__")
