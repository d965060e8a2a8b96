#!/usr/bin/python3
"""Tutorials as Jupyter notebooks: notebooks.py PAGE.md… FOLDER

A block of Python is a cell, a block of sh a cell of the shell (%%sh), a file to be written (toml, after "Write this to
`NAME`") a cell that writes it; all else is text. The pages can be opened by jupytext as well, but for the files.
"""

import json
import pathlib
import re
import sys

BLOCK = re.compile(r"^```(sh|python|toml)\n(.*?)^```\n?", re.M | re.S)
FILE = re.compile(r"Write this to `([^`]+)`")


def file_named(text):
    """The file that the text before a block asks for."""
    return FILE.findall(text)[-1]


def cells(text):
    """(kind, source) of each cell, in order."""
    end = 0
    for found in BLOCK.finditer(text):
        yield "markdown", text[end : found.start()].strip()
        kind, code = found.groups()
        first = {"python": "", "sh": "%%sh\n", "toml": "%%writefile {}\n"}[kind]
        if kind == "toml":
            first = first.format(file_named(text[: found.start()]))
        yield "code", first + code.rstrip()
        end = found.end()
    yield "markdown", text[end:].strip()


def notebook(text):
    """A notebook as nbformat 4 has it."""
    made = []
    for kind, source in cells(text):
        if source:
            code = {"execution_count": None, "outputs": []} if kind == "code" else {}
            made.append({"cell_type": kind, "metadata": {}, "source": source.splitlines(keepends=True)} | code)
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 4}


def write(page, folder):
    """Writes the notebook of a page; returns its file."""
    file = folder / f"{page.stem}.ipynb"
    file.write_text(json.dumps(notebook(page.read_text(encoding="utf-8")), indent=1) + "\n", encoding="utf-8")
    return file


if __name__ == "__main__":
    *pages, target = map(pathlib.Path, sys.argv[1:])
    target.mkdir(parents=True, exist_ok=True)
    for one in pages:
        print(write(one, target))
