#!/usr/bin/python3
"""The tables of JSON keys in the guide and what --json prints are the same keys: test_keys.py PROGRAM.

In docs/guide/commands.md and docs/guide/commands/ a table whose head begins with "key" lists keys; `a.b` is a key of
the object (or of each object of the list) `a`. A type may name keys in braces; "estimate" is `{value, stderr}`, "as `x`"
has the keys of x, "object by …" has keys that are data, "keys above" means those of the page.
"""

import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

GUIDE = pathlib.Path(__file__).parents[2] / "docs" / "guide"
PROGRAM = pathlib.Path(sys.argv.pop()).resolve() if len(sys.argv) > 1 else None
ENSEMBLE = "shard lanes lanes.hits lanes.left lanes.busy no_lanes".split()  # as in carom escape
DISCS = """[table]
shape = "rectangle"
width = 4
height = 4
[interaction]
kind = "hard-discs"
radius = 0.5
[particles]
count = 2
"""
CORNER = """[table]
shape = "rectangle"
width = 1
height = 1
[initial]
position = [0.5, 0.5]
velocity = [1, 1]
"""
POLAR = """[table]
shape = "polar"
radius = "1 + 0.3*cos(phi)"
"""
SOFT = """[table]
shape = "rectangle"
width = 2
height = 2
[[potential]]
kind = "linear"
force = [0, 1]
[run]
t_max = 20
"""
ARC = """[table]
shape = "ellipse"
a = 2
b = 1
"""
# What each command is run with, to print all keys that it has.
RUNS = {
    "escape": ["stadium --trajectories 500 --t-max 50 --shard 1/2 -o x.h5", "soft-lorentz --trajectories 20 --t-max 5",
               "./discs.toml --trajectories 20 --t-max 5", "stadium --trajectories 64 --t-max 50 --set initial.kind=sobol",
               "stadium --trajectories 8 --t-max 5 --set initial.kind=sobol", "./corner.toml --trajectories 20 --t-max 5",
               "three-disc --splitting hits:lin:0:12:13 --population 100", "magnetic-square --trajectories 2000",
               "three-disc --splitting 1,2,3,4,5,6,7,8 --population 100",
               "antidot-magnetic --trajectories 10 --t-max 10 --set integrator.step=0.5",
               "antidot-magnetic --trajectories 10 --t-max 10 --set integrator.step=0.5 --set integrator.unresolved=count"],
    "lyapunov": ["mushroom --closed --trajectories 100 --t-max 2000", "three-disc --trajectories 15000",
                 "wigner --spectrum --trajectories 4 --t-max 20", "stadium --closed --trajectories 20 --t-max 20",
                 "circle --closed --trajectories 50", "./discs.toml --trajectories 20 --t-max 5", "stadium --closed --trajectories 8 --set initial.kind=sobol"],
    "diffusion": ["lorentz-triangular --trajectories 500 --t-max 50 --free-paths",
                  "lorentz-square --trajectories 2000 --t-max 50 --free-paths", "./discs.toml --trajectories 20 --t-max 5",
                  "soft-lorentz --trajectories 20 --t-max 5", "lorentz-square --trajectories 9 --collisions 3"],
    "returns": ["stadium --closed --on wall:bottom --t-max 100 --trajectories 200",
                "./discs.toml --on wall:bottom --trajectories 20 --t-max 20", "./soft.toml --on wall:bottom --trajectories 20"],
    "section": ["ellipse-magnetic --orbits 3 --points 10", "henon-heiles --on x=0 --points 5"],
    "relax": ["wigner --starts 5"],
    "orbit": ["three-disc --hits 3 --zeta --certify", "sinai --hits 2 --starts 200 --tries 20",
              "stadium --hits 2 --starts 200 --tries 20"],
    "run": ["stadium --t-max 1000", "wigner --t-max 1", "henon-heiles --t-max 1", "./discs.toml --t-max 5",
            "antidot-magnetic --set integrator.step=0.5", "siam-photon --precision certified",
            "./corner.toml --precision certified", "henon-heiles --t-max 50 --set integrator.scheme=velocity-verlet --set "
            "integrator.step=0.2", "lorentz-square --t-max 10", "stadium --closed --position 0,0 --velocity 3,4 --t-max 5"],
    "compare": ["stadium --closed --schemes velocity-verlet,arkode", "henon-heiles --schemes velocity-verlet,ruth-3 --t-max 10"],
    "schemes": [""],
    "table": ["mushroom", "./arc.toml -o x.svg", "./polar.toml"],
    "plot": ["stadium -o stadium.png"],
    "systems": ["", "stadium"],
    "validate": ["--scale 0.0005"],
}  # fmt: skip
# Keys that take an accident or minutes to see.
RARE = {"step_halvings", "certified.reason", "reports.state", "state_error_reason", "no_lanes", "orbits.certified.reason",
        "orbits.points.hole", "sweep.doubts", "ties", "note", "walls.axis", "fit.reason", "would_show", "reason", "replicates",
        "no_errors", "archive", "halved_steps", "shortest_step", "what"}  # fmt: skip


def rows(text):
    """(key, type) of each row of a table of keys."""
    for table in re.findall(r"^\| key \|.*\n\|[-|]+\n((?:\|.*\n)*)", text, re.M):
        for row in table.splitlines():
            names, type_ = re.split(r"(?<!\\)\|", row)[1:3]
            for name in re.findall(r"`([^`]+)`", names):
                yield name, type_


class Keys:
    """What a page and the common page say."""

    def __init__(self, *texts):
        self.types = {}
        for text in texts:
            for name, type_ in rows(text):
                self.types[name] = self.types.get(name, "") + type_

    def has(self, path):
        if path in self.types:
            return True
        parent, _, last = path.rpartition(".")
        if not parent:
            return False
        type_ = self.types.get(parent, "")
        first, _, rest = path.partition(".")
        return bool(
            re.search(rf"\{{[^}}]*\b{last}\b", type_)
            or ("estimate" in type_ and last in ("value", "stderr"))
            or "object by" in type_
            or any(self.has(f"{other}.{last}") for other in re.findall(r"as `(\w+)`", type_))
            or ("keys above" in self.types.get(first, "") and self.has(rest))
        )


def paths(value, before=""):
    if isinstance(value, list):
        for one in value:
            yield from paths(one, before)
    elif isinstance(value, dict):
        for name, one in value.items():
            yield before + name
            yield from paths(one, f"{before}{name}.")


@functools.cache
def printed(command):
    found = set()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("discs", DISCS), ("corner", CORNER), ("arc", ARC), ("soft", SOFT), ("polar", POLAR)):
            (pathlib.Path(folder) / f"{name}.toml").write_text(text)
        for line in RUNS[command]:
            done = subprocess.run([PROGRAM, command, *line.split(), "--json", "--quiet"], cwd=folder,
                                  capture_output=True, text=True, check=False)  # fmt: skip
            if done.returncode not in (0, 3):
                raise AssertionError(f"carom {command} {line}: {done.stderr}")
            found |= set(paths(json.loads(done.stdout)))
    return found


COMMON = (GUIDE / "commands.md").read_text(encoding="utf-8").partition("## Common JSON keys")[2]


class Pages(unittest.TestCase):
    def test_every_key_that_is_printed_has_a_row(self):
        escape = (GUIDE / "commands/escape.md").read_text(encoding="utf-8")
        for command in RUNS:
            with self.subTest(command):
                page = Keys(COMMON, (GUIDE / f"commands/{command}.md").read_text(encoding="utf-8"))
                ensemble = {key for key in Keys(escape).types if command in ("lyapunov", "diffusion", "returns")}
                missing = {key for key in printed(command) if not page.has(key)}
                self.assertEqual(missing - {key for key in ENSEMBLE if key.split(".")[0] in ensemble}, set())

    def test_every_row_is_printed(self):
        for command in RUNS:
            with self.subTest(command):
                page = Keys((GUIDE / f"commands/{command}.md").read_text(encoding="utf-8"))
                self.assertEqual(set(page.types) - printed(command) - RARE, set())
        self.assertEqual(set(Keys(COMMON).types) - set().union(*map(printed, RUNS)) - RARE, set())


if __name__ == "__main__":
    unittest.main()
