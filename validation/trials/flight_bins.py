#!/usr/bin/python3
"""Densities, shares and tails of free paths and of returns: how often intervals of 95 % hold the truth.

The truth is the mean over all trials, whose own error is small beside that of one; that tries the size of an error and no
bias. Only bins that all
trials have, of 20 flights or more in the mean. Expected: .92 to .98. Outside: returns to the stem of a mushroom, where one
trajectory makes most long excursions.

    flight_bins.py [--carom PATH] [--quick]
"""
import collections
import sys

import trials
from trials import carom, table, wilson

# name, command, where the bins are, inside
CASES = (
    ("free paths, triangular gas", "diffusion lorentz-triangular --trajectories 300 --t-max 20 --free-paths",
     lambda run: run["free_paths"]["between_hits"]["bins"], True),
    ("first free paths, triangular gas", "diffusion lorentz-triangular --trajectories 2000 --t-max 5 --free-paths",
     lambda run: run["free_paths"]["at_start"]["bins"], True),
    ("free paths, square gas (corridors)", "diffusion lorentz-square --trajectories 300 --t-max 20 --free-paths",
     lambda run: run["free_paths"]["between_hits"]["bins"], True),
    ("return times, stadium", "returns stadium --closed --on wall:bottom --trajectories 300 --t-max 100",
     lambda run: run["return_times"], True),
    ("return hits, stadium", "returns stadium --closed --on wall:bottom --trajectories 300 --t-max 100",
     lambda run: run["return_hits"], True),
    ("return times, mushroom", "returns mushroom --closed --on wall:stem_bottom --trajectories 300 --t-max 400",
     lambda run: run["return_times"], False))


def coverage(values):
    """Of values with errors about their mean: held, all."""
    mean = sum(value for value, _ in values) / len(values)
    return sum(abs(value - mean) <= 1.96 * error for value, error in values), len(values)


def main():
    settings = trials.settings(__doc__)
    number = 40 if settings.quick else 200
    rows, failed = [["bins of", "number", "bins", "held", "least of a bin", "counts below 100", "trials"]], False
    for name, command, bins, inside in CASES:
        seen = collections.defaultdict(list)
        for seed in range(1, number + 1):
            for one in bins(carom(f"{command} --threads 1 --seed {seed}")):
                seen[one["from"], one["to"]].append(one)
        for key in ("density", "longer"):
            held = tried = small_held = small_tried = 0
            worst, used = 1.0, 0
            for ones in seen.values():
                mean = sum(one["count"] for one in ones) / len(ones)
                values = [(one[key], one[f"{key}_stderr"]) for one in ones]
                if len(ones) < number or mean < 20 or all(error == 0 for _, error in values):
                    continue
                one_held, all_of_it = coverage(values)
                used += 1
                worst = min(worst, one_held / all_of_it)
                held, tried = held + one_held, tried + all_of_it
                if mean < 100:
                    small_held, small_tried = small_held + one_held, small_tried + all_of_it
            share = held / tried
            # Bins of one trial depend on each other: the interval is that of as many trials, at least.
            low, high = wilson(share * number, number)
            wrong = inside and (high < 0.92 or low > 0.98)
            failed |= wrong
            rows.append([name, key, used, f"{share:.3f}" + (" !" if wrong else ""), f"{worst:.3f}",
                         f"{small_held / small_tried:.3f}" if small_tried else "", number])
    table(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
