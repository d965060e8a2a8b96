#!/usr/bin/python3
"""Hits on curves and edges of regions: no particle is lost or wrongly singular, and flights have their mean length.

Cardioid, superellipse of exponent 4 and a stadium drawn as a spline, without and with a field: uniform starts, twelve seeds
each, so that the error of the mean flight is measured. Expected: pi A/L within four errors. Then tables that are divided by
edges of regions, where speeds differ and particles alone are counted.

    curves.py [--carom PATH] [--hits 2e7]        of each of the nine systems
"""
import argparse
import math
import pathlib
import statistics
import sys
import tempfile

import trials

STADIUM = [
    *([1 - k / 4, 1] for k in range(8)),
    *([-1 - math.sin(math.pi * k / 12), math.cos(math.pi * k / 12)] for k in range(1, 12)),
    *([-1 + k / 4, -1] for k in range(8)),
    *([1 + math.sin(math.pi * k / 12), -math.cos(math.pi * k / 12)] for k in range(1, 12)),
]
CARDIOID = 'shape = "cardioid"\nradius = 1\n'
CURVES = {
    "cardioid": CARDIOID,
    "spline stadium": f'shape = "spline"\npoints = {STADIUM}\n',
    "superellipse": 'shape = "superellipse"\na = 1\nb = 1\nexponent = 4\n',
}


def disc(x, y, radius, region=""):
    text = f'[[table.obstacle]]\nshape = "circle"\ncenter = [{x}, {y}]\nradius = {radius}\nname = "disc"\n'
    return text + (f'[[table.region]]\nwall = "disc"\n{region}' if region else "")


REGIONS = {
    "disc in a rectangle": 'shape = "rectangle"\nwidth = 4\nheight = 3\n' + disc(2.1, 1.4, 0.7, "potential = 0.2\nB = 1\n"),
    "step, with a hard disc": 'shape = "polygon"\npoints = [[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [0, 2]]\n[[table.region]]\n'
    "start = [2, 2]\npieces = [{ arc_via = [2.3, 1], arc_to = [2, 0] }]\npotential = 0.3\n" + disc(3.2, 0.8, 0.4),
    "disc in a cardioid": CARDIOID + disc(0.8, 0.3, 0.3, "B = 2\npotential = -0.4\n"),
}
SEEDS, TIME = 12, 1000


def trial(name, table, field, hits, file):
    """A row, and is it as expected? Without a field: None."""
    file.write_text(
        f'[table]\n{table}[initial]\nkind = "uniform"\n[run]\nt_max = {TIME}\n' + (f"[field]\nB = {field}\n" if field else "")
    )
    expected = trials.carom(["table", str(file)])["mean_flight"]
    count = max(8, round(hits * expected / TIME / SEEDS))
    runs = [trials.carom(["escape", str(file), "--trajectories", str(count), "--seed", str(seed + 1)]) for seed in range(SEEDS)]
    failed = sum(run[fate] for run in runs for fate in ("lost", "unresolved", "singular"))
    row = [name, field or "", f"{sum(run['collisions'] for run in runs):.4g}", failed]
    if field is None:
        return [*row, "", ""], not failed
    means = [count * TIME / run["collisions"] for run in runs]
    deviation = (statistics.mean(means) - expected) / (statistics.stdev(means) / math.sqrt(SEEDS))
    return [*row, f"{expected:.7f}", f"{deviation:.2f}"], not failed and abs(deviation) < 4


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=trials.program)
    parser.add_argument("--hits", type=float, default=2e7)
    options = parser.parse_args()
    trials.program = options.carom
    rows, good = [("table", "B", "hits", "failed", "mean flight", "deviation in errors")], True
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "system.toml"
        work = [(name, CURVES[name], field) for name in CURVES for field in (0, 0.8)]
        for one in work + [(name, REGIONS[name], None) for name in REGIONS]:
            row, well = trial(*one, options.hits, file)
            rows.append(row)
            good = good and well
    trials.table(rows)
    if not good:
        sys.exit("not as expected")


if __name__ == "__main__":
    main()
