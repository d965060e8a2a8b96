#!/usr/bin/python3
"""`state_error` of `carom run` against steps a sixteenth as long: how often the error is below it.

It is twice the difference to a run with half the step. Random starts; one trajectory each. Expected: it holds in 97 % of
the trials or more where it is stated for the last time. Outside: runs so long that chaos separates them: how often the
error ends before the run does, and how often one that does not is too small.

    state_errors.py [--carom PATH] [--quick]
"""
import math
import pathlib
import sys
import tempfile

import trials
from trials import carom, table, wilson

SOFT = ('[[potential]]\nkind = "expression"\nexpression = "(x^2 + y^2)/2 + x^4/40 + x*y^2/10"\n[particles]\nenergy = 1\n'
        '[initial]\nkind = "rectangle"\nmin = [-1, -1]\nmax = [1, 1]\n')
BOX = ('[table]\nshape = "rectangle"\nwidth = 2\nheight = 2\n[[potential]]\nkind = "gaussian"\nheight = 0.3\nwidth = 0.3\n'
       'center = [0.9, 1.2]\n[particles]\nenergy = 1\n[initial]\nkind = "uniform"\n')
HENON = ('[[potential]]\nkind = "henon-heiles"\n[particles]\nenergy = 0.1\n[initial]\nkind = "rectangle"\nmin = [-0.4, -0.4]\n'
         "max = [0.4, 0.4]\n")
LORENTZ = "soft-lorentz"
# name, system, t, step, scheme, inside
CASES = (("anharmonic well", SOFT, 50, 0.2, "blanes-moan-srkn11b", True), ("anharmonic well", SOFT, 50, 0.02, "velocity-verlet", True),
         ("Henon-Heiles", HENON, 50, 0.2, "blanes-moan-srkn11b", True), ("Henon-Heiles", HENON, 50, 0.1, "forest-ruth-4", True),
         ("bump in a square", BOX, 10, 0.05, "blanes-moan-srkn11b", True), ("bump in a square", BOX, 10, 0.01, "velocity-verlet", True),
         ("soft Lorentz gas", LORENTZ, 5, 0.1, "blanes-moan-srkn11b", True), ("soft Lorentz gas", LORENTZ, 60, 0.1, "blanes-moan-srkn11b", False),
         ("bump in a square", BOX, 200, 0.05, "blanes-moan-srkn11b", False))


def main():
    settings = trials.settings(__doc__)
    number = 20 if settings.quick else 200
    rows, failed = [["system", "t", "step", "scheme", "stated", "position held", "velocity held", "95 %", "middle of error/stated"]], False
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "system.toml"
        for name, system, t, step, scheme, inside in CASES:
            if "\n" in system:
                file.write_text(system)
            held = {"position": 0, "velocity": 0}
            ratios, stated = [], 0
            for seed in range(1, number + 1):
                def run(h):
                    return carom(["run", str(file) if "\n" in system else system, "--t-max", str(t), "--seed", str(seed), "--set",
                                  f"integrator.step={h}", "--set", f"integrator.scheme={scheme}", "--set", "integrator.unresolved=count"])
                one = run(step)
                error = one["state_error"]
                if not error or error["until"] < t:
                    continue
                true = run(step / 16)
                stated += 1
                away = {"position": math.hypot(one["x"] - true["x"], one["y"] - true["y"]),
                        "velocity": math.hypot(one["vx"] - true["vx"], one["vy"] - true["vy"])}
                for key, distance in away.items():
                    held[key] += distance <= error[key]
                ratios.append(away["position"] / error["position"])
            share = [held[key] / stated if stated else float("nan") for key in held]
            low, high = wilson(min(held.values()), stated) if stated else (0, 1)
            failed |= inside and high < 0.97
            rows.append([name, t, step, scheme, f"{stated} of {number}", f"{share[0]:.3f}", f"{share[1]:.3f}",
                         f"{low:.3f} .. {high:.3f}", f"{sorted(ratios)[len(ratios) // 2]:.2g}" if ratios else ""])
    table(rows)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
