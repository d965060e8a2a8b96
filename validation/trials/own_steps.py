"""Steps that the program chooses, in 100 random narrow potentials.

Typed potentials of one to three parts (bumps, wells, ridges and edges, anisotropic and in any
direction, widths of 1e-3 to 1 and heights of 0.1 to 30 times the kinetic energy), half of them in a
hard box, half in a magnetic field, half of the starts aimed at the narrowest part. No step is given.
Expected: `carom run` ends with status 0 in all of them, and agrees with a run of arkode (another
method, steps of its own) within the errors that both state. An orbit that is chaotic is compared
until its stated error has grown to a tenth of the box. With --escape an ensemble of 200
trajectories is flown in each, and all have to be followed: none unresolved, energies kept.
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import trials


def carom(args):
    """What the program prints, its exit status and messages: a refusal is a result here."""
    done = subprocess.run(
        [trials.program, *map(str, args), "--json", "--quiet"],
        capture_output=True,
        text=True,
        check=False,
    )
    result = json.loads(done.stdout) if done.stdout else {}
    return result | {"exit": done.returncode, "messages": done.stderr.strip()}


def part(rng, center, width):
    """A potential that falls within `width` of its centre, and where it is seen from."""
    aspect = 10 ** rng.uniform(0, 1.5) if rng.random() < 0.6 else 1
    long = min(1.0, width * aspect)
    angle = rng.uniform(0, math.pi)
    c, s = math.cos(angle), math.sin(angle)
    u = f"({c:.6f}*(x-{center[0]:.6f})+{s:.6f}*(y-{center[1]:.6f}))/{width:.6g}"
    v = f"({-s:.6f}*(x-{center[0]:.6f})+{c:.6f}*(y-{center[1]:.6f}))/{long:.6g}"
    height = 0.5 * 10 ** rng.uniform(-1, 1.5)
    kind = rng.choice(["gauss", "lorentz", "ridge", "edge", "well"])
    if kind == "gauss":
        return f"{height:.5g}*exp(-(({u})^2+({v})^2)/2)"
    if kind == "lorentz":
        return f"{height:.5g}/(1+({u})^2+({v})^2)"
    if kind == "ridge":
        return f"{min(height, 0.4):.5g}*exp(-({u})^2/2)"
    if kind == "edge":
        return f"{min(height, 0.4):.5g}*tanh({u})"
    return f"-{height:.5g}*exp(-(({u})^2+({v})^2)/2)"


def system(seed, index):
    rng = random.Random(f"own steps {seed} {index}")
    walls, field = index % 2 == 0, index // 2 % 2 == 0
    box = 2.0
    parts, centers = [], []
    for _ in range(rng.randint(1, 3)):
        center = (rng.uniform(0.3, 1.7), rng.uniform(0.3, 1.7))
        centers.append(center)
        parts.append(part(rng, center, 10 ** rng.uniform(-3, 0)))
    start = (rng.uniform(0.1, 1.9), rng.uniform(0.1, 1.9))
    aim = rng.uniform(0, 2 * math.pi)
    if index // 4 % 2 == 0:
        aim = math.atan2(centers[0][1] - start[1], centers[0][0] - start[0])
    text = ""
    if walls:
        text += f'[table]\nshape = "rectangle"\nwidth = {box}\nheight = {box}\n'
    else:
        parts.append("((x-1)^2+(y-1)^2)/2")
    text += f'[[potential]]\nkind = "expression"\nexpression = "{" + ".join(parts)}"\n'
    if field:
        text += f"[field]\nB = {rng.choice([-1, 1]) * 10 ** rng.uniform(-1, 0.7):.4f}\n"
    text += "[particles]\nspeed = 1\n"
    point = (
        f'[initial]\nkind = "point"\nposition = [{start[0]:.6f}, {start[1]:.6f}]\n'
        f"velocity = [{math.cos(aim):.6f}, {math.sin(aim):.6f}]\n"
    )
    area = '[initial]\nkind = "rectangle"\nmin = [0.1, 0.1]\nmax = [1.9, 1.9]\n'
    return text + point, text + area


class Verdicts(dict):
    def add(self, name, index, note=""):
        self.setdefault(name, []).append(index)
        if name != "agrees":
            print(f"  {index}: {name} {note}", flush=True)


def near(a, b):
    """Do two runs agree within what they state? None: the errors are too large to tell."""
    own, other = a["state_error"], b["state_error"]
    if not own or not other:
        return None
    if min(own["until"], other["until"]) < a["t"] or own["position"] + other["position"] > 0.2:
        return None
    way = math.hypot(a["x"] - b["x"], a["y"] - b["y"])
    return way <= own["position"] + other["position"]


def one_run(index, folder, seed, verdicts, parts, times):
    file = folder / f"{index}.toml"
    file.write_text(system(seed, index)[0])
    for t in times:
        run = carom(["run", file, "--t-max", t])
        if run["exit"] != 0:
            return verdicts.add("refused", index, f"status {run['exit']}: {run['messages'][:200]}")
        reference = carom(["run", file, "--t-max", t, "--set", "integrator.scheme=arkode"])
        if run.get("halved_steps"):
            parts.add(index)
        if reference["exit"] != 0:
            return verdicts.add("no reference", index, reference["messages"][:200])
        verdict = near(run, reference)
        if verdict is not None:
            break
    if verdict is None:
        return verdicts.add("chaotic", index, f"at t = {t}")
    return verdicts.add("agrees" if verdict else "WRONG", index)


def one_ensemble(index, folder, seed, verdicts, parts, times):
    file = folder / f"{index}.toml"
    file.write_text(system(seed, index)[1])
    run = carom(
        ["escape", file, "--t-max", times[0], "--trajectories", 200, "--threads", 1]
    )
    if run.get("halved_steps"):
        parts.add(index)
    if run["exit"] != 0:
        return verdicts.add("refused", index, f"status {run['exit']}: {run['messages'][:200]}")
    return verdicts.add("agrees", index)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carom", default=trials.program, help="the program")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--from", type=int, default=0, dest="first")
    parser.add_argument("--escape", action="store_true", help="ensembles in place of runs")
    parser.add_argument("--quick", action="store_true", help="below a minute")
    options = parser.parse_args()
    trials.program = options.carom
    count = 12 if options.quick else options.count
    verdicts, parts = Verdicts(), set()
    one = one_ensemble if options.escape else one_run
    with tempfile.TemporaryDirectory() as name:
        for index in range(options.first, options.first + count):
            one(index, pathlib.Path(name), options.seed, verdicts, parts, [10, 2, 0.5])
    rows = [["", "potentials", "95 %"]]
    for verdict, which in sorted(verdicts.items()):
        low, high = trials.wilson(len(which), count)
        rows.append([verdict, len(which), f"{max(0, low):.3f} to {high:.3f}"])
    rows.append(["with parts of steps", len(parts), ""])
    trials.table(rows)
    return 0 if len(verdicts.get("agrees", [])) == count else 1


if __name__ == "__main__":
    sys.exit(main())
