#!/usr/bin/env python3
"""Does carom.escape cost what the program costs, and give its digest?

    ./dev python validation/benchmarks/python_against_program.py [PAIRS]

Runs the two one after the other, PAIRS times (default 15), each in a process of its own, and
compares the user CPU time of the call of carom.escape with that of the whole program. The time
that Python needs to start and to import numpy (some 0.15 s) is not part of the call. The median of
the paired ratios counts: the machine's other load moves both of a pair. Exit status 1 if a digest
differs or the median is above 1.02.
"""

import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys

CASES = {"stadium": 4_000_000, "magnetic-square": 4_000_000}  # trajectories
MODULE = (
    "import carom, resource, sys\n"
    "begin = resource.getrusage(resource.RUSAGE_SELF).ru_utime\n"
    "result = carom.escape(sys.argv[1], trajectories=int(sys.argv[2]), threads=1)\n"
    "print(result.digest, resource.getrusage(resource.RUSAGE_SELF).ru_utime - begin)\n"
)


def measured(command):
    """What it prints, and its user CPU time in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return done.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def compared(name, trajectories, pairs):
    program = os.environ.get("CAROM_PROGRAM") or str(
        pathlib.Path(__file__).parents[2] / "build" / "release" / "carom"
    )
    options = ["--trajectories", str(trajectories), "--threads", "1", "--json", "--quiet"]
    ratios, own, its = [], [], []
    for pair in range(pairs):
        commands = {
            "module": [sys.executable, "-c", MODULE, name, str(trajectories)],
            "program": [program, "escape", name, *options],
        }
        # Which one comes first changes from pair to pair.
        found = {who: measured(commands[who]) for who in sorted(commands, reverse=pair % 2 == 1)}
        digest, mine = found["module"][0].split()
        mine = float(mine)
        report, other = found["program"]
        if digest != json.loads(report)["digest"]:
            raise SystemExit(f"{name}: the digests differ")
        ratios.append(mine / other)
        own.append(mine)
        its.append(other)
    low, _, high = statistics.quantiles(ratios, n=4)
    middle = statistics.median(ratios)
    print(
        f"{name:18} module {statistics.median(own):6.2f} s, program {statistics.median(its):6.2f} s,"
        f" ratio {middle:.4f} (quartiles {low:.4f} .. {high:.4f}), same digest"
    )
    return middle


def main():
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    worst = max(compared(name, many, pairs) for name, many in CASES.items())
    return 0 if worst <= 1.02 else 1


if __name__ == "__main__":
    sys.exit(main())
