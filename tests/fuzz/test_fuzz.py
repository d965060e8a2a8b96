#!/usr/bin/env python3
"""The fuzzer must tell bad ends from good ones: small programs that end as no program should."""
import argparse
import pathlib
import sys
import tempfile
import tomllib
import random
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation" / "fuzz"))
import fuzz
import mutants

COMPLETED = '{"status": "completed", "t": 1, "x": %s, "y": 0, "vx": 1, "vy": 0}'


def verdict(script, command="run", seconds=30.0, patience=30.0, silence=0.0):
    limits = argparse.Namespace(seconds=seconds, patience=patience, silence=silence, sanitized=False)
    with tempfile.TemporaryDirectory() as folder:
        ended = fuzz.run(["/bin/sh", "-c", script], pathlib.Path(folder), limits)
        return fuzz.judge(ended, command, limits)[0]


class Verdicts(unittest.TestCase):
    def test_good_ends(self):
        self.assertEqual(verdict(f"echo '{COMPLETED % 1}'"), "fine")
        self.assertEqual(verdict("echo 'carom: fuzz.toml, line 3, column 1: table.width: no' >&2; exit 1"), "fine")
        self.assertEqual(verdict("echo '{}'; echo 'a step is too long' >&2; exit 3"), "fine")
        self.assertEqual(verdict("echo '{\"energy_error\": {\"largest\": 0.1}}'; exit 3"), "fine")
        self.assertEqual(verdict("exec sleep 60", seconds=0.1), "fine")

    def test_crashes(self):
        self.assertEqual(verdict("kill -SEGV $$"), "crash")
        self.assertEqual(verdict("kill -TERM $$"), "crash")
        self.assertEqual(verdict("echo 'x.cpp:3:1: runtime error: shift' >&2; exit 1"), "crash")
        self.assertEqual(verdict("exit 130"), "crash")
        self.assertEqual(verdict("exit 134"), "crash")
        self.assertEqual(verdict("echo 'carom: internal error, please report it: x' >&2; exit 3"), "internal")

    def test_ends_that_do_not_come(self):
        self.assertEqual(verdict("trap '' TERM; while :; do sleep 0.05; done", seconds=0.2, patience=0.3), "deaf")
        self.assertEqual(verdict("exec sleep 60", seconds=0.1, silence=0.3), "silent")
        self.assertEqual(verdict("echo '50 %' >&2; exec sleep 60", seconds=0.5, silence=30.0), "fine")

    def test_results(self):
        self.assertEqual(verdict(f"echo '{COMPLETED % 'null'}'"), "null")
        self.assertEqual(verdict("echo '{\"points\": [[1, null]]}'", "section"), "null")
        self.assertEqual(verdict("echo '{\"lost\": 1}'; echo lost >&2; exit 3", "escape"), "lost")
        self.assertEqual(verdict("echo '{\"status\": \"lost\"}'; echo lost >&2; exit 3"), "lost")
        self.assertEqual(verdict("echo '{'"), "output")
        self.assertEqual(verdict("echo '{}'; exit 3"), "output")
        self.assertEqual(verdict("echo '{}'; echo 'carom: line 1: x' >&2; exit 1"), "output")
        self.assertEqual(verdict("echo 'carom: it went wrong' >&2; exit 1"), "place")
        self.assertEqual(verdict("echo 'carom: out of memory' >&2; exit 1"), "memory")


class Cases(unittest.TestCase):
    def test_a_case_is_a_function_of_seed_and_index(self):
        systems = ['[table]\nshape = "circle"\nradius = 1\n']
        cases = [[mutants.make_case(seed, index, systems) for index in range(50)] for seed in (1, 1, 2)]
        self.assertEqual(cases[0], cases[1])
        self.assertNotEqual(cases[0], cases[2])

    def test_sources_are_valid(self):
        chance = random.Random(1)
        for _ in range(300):
            text = mutants.composed(chance)
            self.assertEqual(tomllib.loads(mutants.joined(mutants.split(text))), tomllib.loads(text), text)

    def test_every_mutation_changes_something(self):
        for mutate, _ in mutants.GENTLE + mutants.ROUGH:
            changed = 0
            for seed in range(100):
                chance = random.Random(seed)
                sections = mutants.split(mutants.composed(chance))
                before = mutants.joined(sections)
                mutate(chance, sections)
                changed += mutants.joined(sections) != before
            self.assertGreater(changed, 20, mutate.__name__)


if __name__ == "__main__":
    unittest.main()
