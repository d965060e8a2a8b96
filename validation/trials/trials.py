"""Helpers of the trials: run the program, intervals of shares, tables.

CAROM_SEEDS=N in the environment shifts all seeds by N: trials that nothing was chosen by.
"""
import argparse
import json
import math
import os
import subprocess

program = "build/release/carom"
shift = int(os.environ.get("CAROM_SEEDS", "0"))


def settings(doc):
    """The options that all trials have: --carom, which is `program` from then on, and --quick."""
    global program
    parser = argparse.ArgumentParser(description=doc.split("\n", 1)[0])
    parser.add_argument("--carom", default=program, help="the program")
    parser.add_argument("--quick", action="store_true", help="few trials")
    given = parser.parse_args()
    program = given.carom
    return given


def carom(args):
    """The JSON object that `carom ARGS --json --quiet` prints; args is a list or one text."""
    words = args.split() if isinstance(args, str) else list(args)
    if "--seed" in words:
        at = words.index("--seed") + 1
        words[at] = str(int(words[at]) + shift)
    done = subprocess.run([program, *words, "--json", "--quiet"], capture_output=True, text=True, check=False)
    if not done.stdout:
        raise SystemExit(f"{program} {' '.join(words)}\n{done.stderr}")
    return json.loads(done.stdout)


def wilson(k, n, z=1.96):
    """The interval of 95 % of a share of which k of n were seen."""
    share, square = k / n, z * z / n
    middle = (share + square / 2) / (1 + square)
    half = z * math.sqrt(share * (1 - share) / n + square / (4 * n)) / (1 + square)
    return middle - half, middle + half


def table(rows):
    """Prints rows of texts in columns; the first row is the head."""
    widths = [max(len(str(cell)) for cell in column) for column in zip(*rows)]
    for row in rows:
        print("  ".join(str(cell).ljust(width) for cell, width in zip(row, widths)).rstrip(), flush=True)
