#!/usr/bin/python3
"""Mean return times and hits to a wall against Kac's lemma: how often intervals of 95 % hold the truth (expected: 90 to 99 %
of 200 seeds).

    returns.py [--carom PATH] [--quick]
"""
import sys

import trials
from trials import carom, table, wilson

CASES = (("stadium", "bottom", 500, 200), ("magnetic-square", "bottom", 500, 200), ("mushroom", "stem_bottom", 500, 400), ("sinai", "disc", 300, 100))


def main():
    settings = trials.settings(__doc__)
    number = 40 if settings.quick else 200
    rows, failed = [("system", "wall", "mean", "held", "of", "95 % interval")], False
    for system, wall, size, t_max in CASES:
        runs = [
            carom(f"returns {system} --closed --on wall:{wall} --trajectories {size} --t-max {t_max} --seed {seed}")
            for seed in range(1, number + 1)
        ]
        for key in ("time", "hits"):
            means = [(run[f"mean_{key}"], run[f"expected_{key}"]) for run in runs]
            means = [(mean, expected) for mean, expected in means if mean["stderr"] > 0]
            if not means:
                continue  # every hit is a return
            held = sum(abs(mean["value"] - expected) < 1.96 * mean["stderr"] for mean, expected in means)
            low, high = wilson(held, len(means))
            failed |= high < 0.90 or low > 0.99 or not settings.quick and not 0.90 <= held / len(means) <= 0.99
            rows.append((system, wall, key, f"{held / len(means):.3f}", len(means), f"{low:.3f} to {high:.3f}"))
    table(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
