#!/usr/bin/python3
"""Compares what pages print as output with what their commands print: docs/outputs.py PROGRAM [--renew] [PAGE…].

The blocks of a page run in order, in a folder of their own. A block without a language is output: of the commands in
its own lines that begin with "$ ", else of the shell or Python block before it. Lines may be left out; "…" stands for
any text. Seconds, rates and numbers of threads are not compared. --renew writes the lines that have changed anew, each
in place of the one that it resembles most; the pictures of guide/figures that a page shows and its code draws, too.
"""

import argparse
import contextlib
import difflib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "guide").rglob("*.md"))]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.M | re.S)
# What differs from run to run and from machine to machine.
MEASURED = re.compile(r"\b\d[\d.]*(?:e[+-]?\d+)? (?:s|ms|us|ns|min|[kM]?hits/s)\b|\bon \d+ threads?\b")


def is_output(language, text):
    return not language and not text.startswith(("carom ", "pip ", "tar ", "cmake ", "sudo ", "./dev ", "mpirun ", "brew "))


class Page:
    def __init__(self, path, program):
        self.path, self.text = path, path.read_text(encoding="utf-8")
        self.program = pathlib.Path(program).resolve()
        self.faults, self.edits, self.names = [], [], {}

    def check(self, draw=False):
        """Runs the blocks up to the last output; faults has what differs, edits what would mend it.
        If `draw`, runs all and keeps the pictures."""
        blocks = list(BLOCK.finditer(self.text))
        outputs = [i for i, block in enumerate(blocks) if is_output(block[1], block[2])]
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            printed = ""
            shown = re.findall(r"\]\((\.\./figures/(\w[\w-]*\.png))\)", self.text) if draw else []
            for i, block in enumerate(blocks[: len(blocks) if shown else outputs[-1] + 1 if outputs else 0]):
                if i in outputs:
                    self._output(block, printed)
                elif block[1] == "toml":
                    name = re.search(r"\./(\w+\.toml)", self.text[block.end() :])
                    if name:
                        pathlib.Path(name[1]).write_text(block[2], encoding="utf-8")
                elif block[1] == "python":
                    printed = self._python(block[2])
                elif block[1] in ("sh", ""):
                    printed = self._shell(block[2])
            for place, name in shown:
                if pathlib.Path(name).exists():
                    shutil.copyfile(name, self.path.parent / place)
        return self

    def _shell(self, code):
        printed = ""
        for line in re.sub(r"\\\n *", "", code).splitlines():
            line = re.sub(r"^\./dev run ", "carom ", line)
            if line.startswith("carom "):
                environment = os.environ | {"PATH": f"{self.program.parent}:{os.environ['PATH']}"}
                done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, env=environment, check=False)
                printed += done.stdout + done.stderr
        return printed

    def _python(self, code):
        printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(printed):
                exec(compile(code, str(self.path), "exec"), self.names)
        except ModuleNotFoundError:
            return None  # a package of others that is not here: what it would print is not compared
        return printed.getvalue()

    def _output(self, block, printed):
        if printed is None:
            return
        start = block.start(2)
        lines = block[2].splitlines(keepends=True)
        left = printed.splitlines()
        for line in lines:
            shown = line.rstrip("\n")
            if shown.startswith("$ "):
                left = self._shell(shown[2:]).splitlines()
            elif shown.strip(" …"):
                found = next((i for i, one in enumerate(left) if same(shown, one)), None)
                if found is not None:
                    left = left[found + 1 :]
                else:
                    self._fault(start, shown, left)
            start += len(line)

    def _fault(self, start, shown, left):
        place = f"{os.path.relpath(self.path, ROOT)}:{self.text.count(chr(10), 0, start) + 1}"
        nearest = max(left, key=lambda one: difflib.SequenceMatcher(None, shown, one).ratio(), default="")
        alike = difflib.SequenceMatcher(None, shown, nearest).ratio() > 0.5
        self.faults.append(f"{place}:\n- {shown}\n+ {nearest if alike else '(no line like it)'}")
        if alike and "…" not in shown.strip():
            self.edits.append((start, len(shown), nearest))

    def renew(self):
        text = self.text
        for start, length, line in reversed(self.edits):
            text = text[:start] + line + text[start + length :]
        self.path.write_text(text, encoding="utf-8")


def same(shown, line):
    if MEASURED.search(shown):
        shown, line = (" ".join(MEASURED.sub("#", one).split()) for one in (shown, line))
    parts = [re.escape(part.strip()) if "…" in shown else re.escape(part) for part in shown.split("…")]
    return re.fullmatch(r"\s*" * ("…" in shown) + ".*".join(parts), line) is not None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the program carom")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    parser.add_argument("--renew", action="store_true")
    given = parser.parse_intermixed_args()
    stale = False
    for path in [page.resolve() for page in given.pages] or PAGES:
        page = Page(path, given.program).check(draw=given.renew)
        stale |= bool(page.faults)
        print(*page.faults, sep="\n", end="\n" if page.faults else "", flush=True)
        if given.renew:
            page.renew()
    sys.exit(stale)


if __name__ == "__main__":
    main()
