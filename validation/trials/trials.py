"""What the scripts of trials share: running the program, intervals of a share of trials, tables of text."""
import argparse
import json
import math
import os
import subprocess

_arguments = argparse.ArgumentParser()
_arguments.add_argument("--carom", default="build/release/carom", help="the program that is tried")
_arguments.add_argument("--quick", action="store_true", help="fewer trials, in less than a minute")


def arguments():
    """The options that every script of trials has."""
    chosen = _arguments.parse_args()
    global _program
    _program = chosen.carom
    return chosen


def carom(line, seed):
    """The JSON object of `carom LINE --seed SEED`, computed on one thread. Ends the trials where the program fails;
    status 3 (a doubt about energies or forces) has a result, too."""
    command = [_program, *line.split(), "--seed", str(seed), "--json", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    if done.returncode not in (0, 3):
        raise SystemExit(f"{' '.join(command)}: status {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


def wilson(hits, trials, quantile=1.959964):
    """The 95 % interval of a probability of which `hits` of `trials` were seen (Wilson 1927)."""
    share = hits / trials
    square = quantile**2 / trials
    centre = (share + square / 2) / (1 + square)
    half = quantile * math.sqrt(share * (1 - share) / trials + square / (4 * trials)) / (1 + square)
    return centre - half, centre + half


def outside(hits, trials, least=0.92, most=0.98):
    """True where the share of intervals that held the truth cannot be that of the range, by its own Wilson interval."""
    low, high = wilson(hits, trials)
    return high < least or low > most


def table(rows):
    """Rows of cells as lines of text, columns aligned; the first row is the head."""
    cells = [[cell if isinstance(cell, str) else f"{cell:.4g}" for cell in row] for row in rows]
    widths = [max(len(row[k]) for row in cells) for k in range(len(cells[0]))]
    for row in cells:
        print("  ".join([row[0].ljust(widths[0])] + [c.rjust(w) for c, w in zip(row[1:], widths[1:])]).rstrip())
