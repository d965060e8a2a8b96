#!/usr/bin/python3
"""The exponent of one orbit: its error holds, or is doubted.

300 single orbits each of the stadium (t = 3e4, 1e5; uniform starts) and of Hénon-Heiles at E = 1/8 (t = 1e4; from (0, -1/4),
displaced by multiples of 1e-9), and 300 times 10 orbits of the stadium (t = 3000). The reference is the mean of all. Expected:
1.96 errors hold the truth, or `long_enough` is false, in 93 % or more; and more errors hold than by blocks alone.

    one_orbit_exponent.py [--carom PATH] [--quick]
"""
import argparse
import statistics
import sys

import trials
from trials import carom, table, wilson

CASES = {
    "stadium, t = 3e4": ("stadium --closed --set initial.kind=uniform --t-max 3e4 --trajectories 1", False),
    "stadium, t = 1e5": ("stadium --closed --set initial.kind=uniform --t-max 1e5 --trajectories 1", False),
    "stadium, 10 of t = 3000": ("stadium --closed --set initial.kind=uniform --t-max 3000 --trajectories 10", False),
    "henon-heiles, t = 1e4": ("henon-heiles --t-max 1e4 --trajectories 1", True),
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--carom", default=trials.program)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    trials.program = options.carom
    rows, good = [["case", "orbits", "lambda", "scatter", "held by blocks", "held", "doubted", "held or doubted", ""]], True
    for name, (command, displaced) in CASES.items():
        number = 300 if not options.quick else 20 if displaced else 60
        found = []
        for seed in range(1, number + 1):
            words = ["lyapunov", *command.split(), "--seed", str(seed)]
            if displaced:
                words += ["--set", f"initial.position=[0, -0.25{seed + trials.shift:07d}]"]
            found.append(carom(words))
        values = [one["lambda"][0]["value"] for one in found]
        truth = statistics.fmean(values)
        held = [abs(v - truth) <= 1.96 * one["lambda"][0]["stderr"] for v, one in zip(values, found)]
        blocks = [abs(v - truth) <= 1.96 * one["block_errors"][-1]["stderr"] for v, one in zip(values, found)]
        doubted = [not one["long_enough"] for one in found]
        right = sum(a or b for a, b in zip(held, doubted))
        fine = wilson(right, number)[1] >= 0.93 and sum(held) >= sum(blocks)
        good = good and fine
        rows.append([
            name, number, f"{truth:.5f}", f"{statistics.stdev(values):.5f}", f"{sum(blocks) / number:.3f}",
            f"{sum(held) / number:.3f}", f"{sum(doubted) / number:.3f}", f"{right / number:.3f}", "" if fine else "!",
        ])  # fmt: skip
    table(rows)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
