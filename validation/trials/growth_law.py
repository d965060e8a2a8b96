#!/usr/bin/python3
"""Linear growth of deviations: found where it is, and not where an exponent above `would_show` is.

Regular: a concentric annulus, a circle in a field, a harmonic well with and without walls; deviations grow linearly.
Expected: no exponent in 97 % of the trials or more, at 100 mean flights and more. Chaotic: stadiums whose straight sides are
short (a = 3e-5 to 1e-3), whose exponents are 5e-3 to .03 by runs 20 times as long. Expected: wherever the law is called
linear, the exponent is below `would_show`, in 97 % or more.

    growth_law.py [--carom PATH] [--quick]
"""
import collections
import pathlib
import sys
import tempfile

import trials
from trials import carom, table, wilson

REGULAR = {
    "annulus": ('[table]\nshape = "annulus"\nouter = 1\ninner = 0.4\noffset = 0\n', (100, 400)),
    "circle in a field": ('[table]\nshape = "circle"\nradius = 1\n[field]\nB = 0.5\n', (200, 800)),
    "harmonic well": ('[[potential]]\nkind = "harmonic"\nomega_x = 1\nomega_y = "sqrt(2)"\n[particles]\nenergy = 1\n'
                      "[integrator]\nstep = 0.1\n", (200,)),
    "harmonic well in a square": ('[table]\nshape = "rectangle"\nwidth = 2\nheight = 2\n[[potential]]\nkind = "harmonic"\n'
                                  'omega_x = 1\nomega_y = "sqrt(2)"\ncenter = [1, 1]\n[particles]\nenergy = 2\n[integrator]\nstep = 0.1\n', (200,)),
}
STARTS = '[initial]\nkind = "rectangle"\nmin = [0.5, 0.5]\nmax = [0.7, 0.7]\n'


def main():
    settings = trials.settings(__doc__)
    number = 20 if settings.quick else 200
    rows, failed = [["system", "t", "linear", "not known", "exponential", "right", "trials"]], False

    def row(name, t, results, right):
        nonlocal failed
        laws = collections.Counter(result["law"] for result in results)
        high = wilson(right, len(results))[1]
        failed |= high < 0.97
        rows.append([name, t, laws["linear"], laws[None], laws["exponential"], f"{right / len(results):.3f}", len(results)])

    with tempfile.TemporaryDirectory() as folder:
        for name, (text, times) in REGULAR.items():
            file = pathlib.Path(folder) / "regular.toml"
            file.write_text(text + STARTS)
            for t in times:
                results = [carom(["lyapunov", str(file), "--trajectories", "10", "--t-max", str(t), "--threads", "1", "--seed", str(seed)])
                           for seed in range(1, number + 1)]
                row(name, t, results, sum(result["law"] != "exponential" for result in results))
    for a in (3e-5, 1e-4, 1e-3):
        def stadium(t, count, seed):
            return carom(f"lyapunov stadium --closed --set table.half_length={a} --trajectories {count} --t-max {t} --threads 1 --seed {seed}")
        truth = stadium(20000, 40, 1)["lambda"][0]["value"]
        for t in (150, 300, 1000):
            results = [stadium(t, 10, seed) for seed in range(1, number + 1)]
            wrong = sum(result["law"] == "linear" and result["would_show"] < truth for result in results)
            row(f"stadium a = {a:g}, lambda = {truth:.4f}", t, results, len(results) - wrong)
    table(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
