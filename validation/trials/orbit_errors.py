#!/usr/bin/python3
"""Errors of periodic orbits against orbits that are proved to 20 decimals (`carom orbit --certify`).

Stadiums, Sinai billiards, three discs and lemons of random sizes. Expected: position_error and length_error hold always,
they are bounds; trace_error, an estimate, in .98 or more. Outside: orbits whose trace is within 1e-3 of +-2.

    orbit_errors.py [--carom PATH] [--quick]
"""
import random
import sys
from decimal import Decimal

import trials
from trials import carom, table

CASES = {
    "stadium": ("stadium --closed --hits 6", lambda rng: f"table.half_length={rng.uniform(0.1, 3)}"),
    "sinai": ("sinai --hits 3", lambda rng: f"table.radius={rng.uniform(0.05, 0.49)}"),
    "three discs": ("three-disc --hits 6", lambda rng: f"table.radius={rng.uniform(0.2, 2.5)}"),
    "lemon": ("circle --closed --hits 5", lambda rng: f'table={{shape="lemon", radius=1, separation={rng.uniform(0.05, 1.9)}}}'),
    "lemon, nearly degenerate": ("circle --closed --hits 2",
                                 lambda rng: f'table={{shape="lemon", radius=1, separation={rng.choice([0, 1]) + 10 ** -rng.uniform(1.5, 8)}}}'),
}


def main():
    settings = trials.settings(__doc__)
    number = 5 if settings.quick else 25
    rows, failed = [["orbits", "proved", "places hold", "largest/bound", "lengths hold", "largest/bound", "traces hold", "largest/estimate"]], False
    degenerate = []
    for name, (command, size) in CASES.items():
        ratios = []
        for seed in range(1, number + 1):
            rng = random.Random(f"{name} {seed + trials.shift}")
            found = carom([*f"orbit {command} --starts 3000 --tries 300 --certify --threads 1".split(), "--set", size(rng)])
            for orbit in found["orbits"]:
                proved = orbit["certified"]
                if not proved or not proved.get("proven") or orbit["family"]:
                    continue
                away = max(abs(Decimal(point[axis]) - Decimal(true))
                           for axis in ("x", "y") for point, true in zip(orbit["points"], proved[axis]))
                one = [float(away) / orbit["position_error"],
                       float(abs(Decimal(orbit["length"]) - Decimal(proved["length"]))) / orbit["length_error"],
                       float(abs(Decimal(orbit["trace"]) - Decimal(proved["trace"]))) / orbit["trace_error"]]
                (degenerate if abs(abs(orbit["trace"]) - 2) < 1e-3 else ratios).append(one)
        if ratios:
            failed |= add_row(rows, name, ratios)
    if degenerate:
        add_row(rows, "trace near +-2", degenerate)
    table(rows)
    return 1 if failed else 0


def add_row(rows, name, ratios):
    row, bad = [name, len(ratios)], False
    for k, least in enumerate((1, 1, 0.98)):
        held = sum(ratio[k] <= 1 for ratio in ratios) / len(ratios)
        bad |= held < least
        row += [f"{held:.4f}", f"{max(ratio[k] for ratio in ratios):.3g}"]
    rows.append(row)
    return bad


if __name__ == "__main__":
    sys.exit(main())
