#!/usr/bin/python3
"""Exponents of all directions, the entropy of several particles, and the exponent at growing times: how often intervals of
95 % hold the truth.

Hard discs in a square. The truth is the mean over all trials; the entropy of one particle in a
stadium is known: lambda by 2e5 orbits. Expected: .92 to .98 of the trials
for the positive exponents, the entropy and lambda(t). Outside: runs of ten units of time, in which deviations have not found
their directions yet; against the means of the longer runs.

    spectra.py [--carom PATH] [--quick]
"""
import pathlib
import sys
import tempfile

import trials
from trials import carom, table, wilson


def discs(count):
    return ('[table]\nshape = "rectangle"\nwidth = 2\nheight = 2\n[interaction]\nkind = "hard-discs"\nradius = 0.25\n'
            f'[particles]\ncount = {count}\nspeed = 1\n[initial]\nkind = "uniform"\n')


# name, system, trajectories, t, inside
CASES = (("stadium", "stadium", 100, 100, True), ("two discs", discs(2), 60, 100, True), ("three discs", discs(3), 60, 100, True),
         ("two discs", discs(2), 60, 10, False), ("three discs", discs(3), 60, 10, False))


def main():
    settings = trials.settings(__doc__)
    number = 40 if settings.quick else 200
    rows, failed = [["system", "t", "number", "truth", "held", "95 %", "doubted", "held or doubted", "trials"]], False

    known = {}
    many = carom("lyapunov stadium --closed --trajectories 200000 --t-max 100")

    def row(name, t, what, values, inside, truth=None):
        nonlocal failed
        if truth is None:
            truth = sum(value["value"] for value, _ in values) / len(values) if inside else known[name, what]
        held = [abs(value["value"] - truth) <= 1.96 * value["stderr"] for value, _ in values]
        low, high = wilson(sum(held), len(held))
        doubted = sum(doubt for _, doubt in values)
        either = sum(ok or doubt for ok, (_, doubt) in zip(held, values))
        failed |= inside and (high < 0.92 or low > 0.98)
        if inside:
            known[name, what] = truth
        rows.append([name, t, what, f"{truth:.5f}", f"{sum(held) / len(held):.3f}", f"{low:.3f} .. {high:.3f}",
                     f"{doubted / len(values):.3f}", f"{either / len(values):.3f}", len(values)])

    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "system.toml"
        for name, system, count, t, inside in CASES:
            if "\n" in system:
                file.write_text(system)
            command = ["lyapunov", str(file) if "\n" in system else system, "--closed", "--spectrum", "--threads", "1"]
            found = [carom([*command, "--trajectories", str(count), "--t-max", str(t), "--seed", str(seed)]) for seed in range(1, number + 1)]
            found = [(run, bool(run["notes"])) for run in found if run["spectrum"]]
            if len(found) < number:
                rows.append([name, t, "no exponents", "", "", "", "", "", number - len(found)])
            if len(found) < number / 2:
                continue
            true = many["lambda"][0]["value"] if name == "stadium" else None
            first = found[0][0]
            for k in range((len(first["spectrum"]) - first["zeros"]["count"]) // 2):
                row(name, t, f"exponent {k + 1}", [(run["spectrum"][k], doubt) for run, doubt in found], inside, true)
            row(name, t, "entropy", [(run["entropy"], doubt) for run, doubt in found], inside, true)
    found = [carom(f"lyapunov stadium --closed --trajectories 100 --t-max 100 --seed {seed}") for seed in range(1, number + 1)]
    for k, point in enumerate(many["convergence"]):
        points = [run["convergence"][k] for run in found]
        row("stadium", 100, f"lambda({point['t']:.4g})",
            [({"value": at["lambda"], "stderr": at["lambda_stderr"]}, False) for at in points], True, point["lambda"])
    table(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
