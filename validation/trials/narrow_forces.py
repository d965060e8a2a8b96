#!/usr/bin/python3
"""Random systems whose forces are narrow, steep or many: is any run of `carom run` wrong in silence?

Each system is followed by cvode and arkode, by three fixed schemes at a sensible step and at one that is 2 to 100 times as
long as the passage through its narrowest force, and with the step that Carom chooses. The end of each run is compared with
the reference of `carom compare` (34 digits, where these were found), at a time until which small errors have grown 100
times at most. Expected: a run agrees within the error that it states, or says why it does not; with the step that Carom
chooses it agrees. With --escape an ensemble of 200 trajectories is flown in each system: all have to be followed.

    narrow_forces.py [--carom PATH] [--count N] [--seed S] [--from I] [--escape] [--keep FOLDER] [--quick]
"""
import argparse
import collections
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import trials

KINETIC = 0.5  # of every start
FAMILIES = ("bump", "bumps", "ridges", "waves", "lattice", "frame", "slanted")
SCHEMES = (("velocity-verlet", 0.02), ("blanes-moan-s6", 0.1), ("blanes-moan-srkn11b", 0.25))
LOOSE = 1e-3  # of positions; of velocities, over the largest speed
ROUNDING = 1e-14  # granted beside what is stated, times the growth: every step is rounded
SILENT = ("beyond", "WRONG", "slow", "crashed")


def log_uniform(rng, low, high):
    return low * (high / low) ** rng.random()


def height_of(rng, most=1000):
    height = log_uniform(rng, 0.1 * KINETIC, most * KINETIC)
    return -min(height, 50 * KINETIC) if rng.random() < 0.12 else height  # wells, not too deep


def direction(rng):
    """Along an axis or oblique."""
    angle = rng.choice([0, 0.5, 1, 1.5]) * math.pi if rng.random() < 0.5 else rng.uniform(0, 2 * math.pi)
    return math.cos(angle), math.sin(angle)


class System:
    """A text of TOML, made from a seed and an index."""

    def __init__(self, seed, index):
        rng = random.Random(f"narrow forces {seed} {index}")
        while True:
            self.make(rng, FAMILIES[index % len(FAMILIES)])
            if self.choose_start(rng):
                return

    def make(self, rng, family):
        self.family, self.parts, self.targets, self.lattice, self.extra = family, [], [], None, []
        self.walls = family != "lattice" and rng.random() < 0.5
        self.sides = (rng.uniform(1, 3), rng.uniform(1, 3)) if self.walls else (2, 2)
        self.field = rng.uniform(-3, 3) if rng.random() < 0.2 else 0
        self.widths, self.t_max = [], rng.uniform(2, 6)
        getattr(self, f"add_{family}")(rng)

    def place(self, rng):
        return rng.uniform(0.05, self.sides[0] - 0.05), rng.uniform(0.05, self.sides[1] - 0.05)

    def add_bump(self, rng):
        (a, b), w, h = self.place(rng), log_uniform(rng, 0.002, 0.5), height_of(rng)
        square = f"((x-{a!r})^2+(y-{b!r})^2)"
        self.parts.append(f"({h!r})/(1+{square}/{w!r}^2)" if rng.random() < 0.2 else f"({h!r})*exp(-{square}/(2*{w!r}^2))")
        self.widths.append(w)
        self.targets.append((a, b))

    def add_bumps(self, rng):
        for _ in range(rng.randint(2, 6)):
            self.add_bump(rng)

    def add_ridges(self, rng):
        for _ in range(rng.randint(1, 2)):
            (a, b), (x, y), w, h = direction(rng), self.place(rng), log_uniform(rng, 0.002, 0.5), height_of(rng)
            s = f"(({a!r})*(x-{x!r})+({b!r})*(y-{y!r}))/{w!r}"
            kind = rng.choice(["ridge", "ridge", "soft wall", "edge"])
            self.parts.append({"ridge": f"({h!r})*exp(-({s})^2/2)", "soft wall": f"{KINETIC}*exp(-({s}))",
                               "edge": f"({h!r})*(1-tanh({s}))/2"}[kind])
            self.widths.append(w)
            self.targets.append((x, y))

    def add_waves(self, rng):
        length, h, kind = log_uniform(rng, 0.01, 0.5), log_uniform(rng, 0.1 * KINETIC, 100 * KINETIC), rng.randrange(3)
        if kind == 2:  # sharp periodic peaks
            sharp, ratio = log_uniform(rng, 1, 100), rng.uniform(0.5, 1)
            self.parts.append(f"{h!r}*exp({sharp!r}*(cos(x/{length!r})+cos({ratio!r}*y/{length!r})-2))")
            self.widths.append(length / math.sqrt(sharp))
            return
        turn = rng.choice([0, rng.uniform(0, math.pi)])
        for i in range(2 + kind):
            angle = turn + i * math.pi / (2 + kind)
            self.parts.append(f"{h!r}*cos((({math.cos(angle)!r})*x+({math.sin(angle)!r})*y)/{length!r}-{rng.uniform(0, 6)!r})")
        self.widths.append(length)

    def add_lattice(self, rng):
        self.sides = (1, 1)
        self.lattice = [[1, 0], rng.choice([[0, 1], [0.5, 0.8660254037844386], [rng.uniform(-0.4, 0.4), 0.8660254037844386]])]
        h, bells = log_uniform(rng, 0.1 * KINETIC, 1000 * KINETIC), rng.random() < 0.5
        w, r = log_uniform(rng, 0.002, 0.12 if bells else 0.03), rng.uniform(0.05, 0.35)
        shape = f'kind = "gaussian"\nwidth = {w!r}' if bells else f'kind = "fermi"\nradius = {r!r}\nsoftness = {w!r}'
        self.extra.append(f"[[potential]]\n{shape}\nheight = {h!r}\nlattice = true\n")
        self.far = 6 * w if bells else r + 12 * w  # where it is felt no more
        self.widths.append(w)
        self.targets += [(i * 1 + j * self.lattice[1][0], j * self.lattice[1][1]) for i in range(2) for j in range(2)]

    def add_frame(self, rng):
        """Bumps in a field and a force at right angles to the drift: a lattice that is seen from a frame that moves."""
        self.field = rng.choice([-1, 1]) * log_uniform(rng, 0.3, 10)
        for _ in range(rng.randint(1, 3)):
            self.add_bump(rng)
        (a, b), drift = direction(rng), log_uniform(rng, 0.2, 5)
        self.extra.append(f'[[potential]]\nkind = "expression"\nexpression = "-(({a * drift * self.field!r})*x+'
                          f'({b * drift * self.field!r})*y)"\n')

    def add_slanted(self, rng):
        """Bumps and ridges that are longer than wide, in any direction; in a well where there are no walls."""
        for _ in range(rng.randint(1, 3)):
            (x, y), w = self.place(rng), log_uniform(rng, 1e-3, 1)
            angle, long = rng.uniform(0, math.pi), min(1, w * log_uniform(rng, 1, 30))
            c, s, h = math.cos(angle), math.sin(angle), height_of(rng, 30)
            u, v = f"({c!r}*(x-{x!r})+{s!r}*(y-{y!r}))/{w!r}", f"({-s!r}*(x-{x!r})+{c!r}*(y-{y!r}))/{long!r}"
            self.parts.append(f"({h!r})*exp(-(({u})^2+({v})^2)/2)")
            self.widths.append(w)
            self.targets.append((x, y))
        if not self.walls:
            self.parts.append("((x-1)^2+(y-1)^2)/2")

    def potential(self, x, y):
        """Without what is not typed as a formula with a finite range."""
        if self.lattice and min(math.dist((x, y), at) for at in self.targets) < self.far:
            return math.inf
        names = {"x": x, "y": y, "exp": lambda a: math.exp(min(a, 700)), "cos": math.cos, "tanh": math.tanh}
        return sum(eval(part.replace("^", "**"), {"__builtins__": {}}, names) for part in self.parts)

    def choose_start(self, rng):
        """Little of the energy is potential there; more than half of the starts aim at a force."""
        aimed = bool(self.targets) and rng.random() < 0.6
        for _ in range(200):
            x, y = self.place(rng)
            angle = rng.uniform(0, 2 * math.pi)
            if aimed:
                a, b = rng.choice(self.targets)
                distance = math.dist((x, y), (a, b))
                if distance < 3 * min(self.widths):
                    continue
                angle = math.atan2(b - y, a - x) + rng.uniform(-2, 2) * min(1, min(self.widths) / distance)
            if self.potential(x, y) <= 0.5 * KINETIC:
                self.start = x, y, math.cos(angle), math.sin(angle)
                return True
        return False

    def toml(self, integrator="", t_max=None, ensemble=False):
        text = "".join(self.extra)
        if self.parts:
            text += f'[[potential]]\nkind = "expression"\nexpression = "{" + ".join(self.parts)}"\n'
        if self.walls:
            text += f'[table]\nshape = "rectangle"\nwidth = {self.sides[0]!r}\nheight = {self.sides[1]!r}\n'
        if self.lattice:
            text += f"[lattice]\nvectors = {self.lattice}\n"
        if self.field:
            text += f"[field]\nB = {self.field!r}\n"
        x, y, vx, vy = self.start
        if ensemble:
            text += f'[initial]\nkind = "rectangle"\nmin = [0.1, 0.1]\nmax = [{0.9 * self.sides[0]!r}, {0.9 * self.sides[1]!r}]\n'
        else:
            text += f'[initial]\nkind = "point"\nposition = [{x!r}, {y!r}]\nvelocity = [{vx!r}, {vy!r}]\n'
        return text + f"[integrator]\n{integrator}\n[run]\nt_max = {self.t_max if t_max is None else t_max!r}\n"


def ask(file, words, seconds=300):
    """What the program prints, its exit status and messages: a refusal is an answer, too."""
    try:
        done = subprocess.run([trials.program, *words, str(file), "--json", "--quiet"], capture_output=True, text=True,
                              check=False, timeout=seconds)
    except subprocess.TimeoutExpired:
        return {"exit": None, "messages": f"nothing after {seconds} s"}
    answer = json.loads(done.stdout) if done.stdout else {}
    return answer | {"exit": done.returncode, "messages": done.stderr.strip().split("\n", 1)[0]}


def verdict_of(run, reference, growth, t, fastest):
    """One word, and how far the run is from the reference."""
    if run["exit"] is None or run["exit"] < 0:
        return ("slow" if run["exit"] is None else "crashed"), run["messages"]
    if "status" not in run:
        return "refused", run["messages"]
    if run["status"] == "unresolved" or run.get("unresolved_steps"):
        return "unresolved", ""
    if run["status"] not in ("completed", "pinned"):
        return "lost", run["status"]
    if run["exit"] == 3:
        return "energy", run["messages"]
    stated = run["state_error"]
    if not stated or stated["until"] < t:
        return "loosely", ""
    away = (math.hypot(run["x"] - reference["x"], run["y"] - reference["y"]),
            math.hypot(run["vx"] - reference["vx"], run["vy"] - reference["vy"]))
    claimed = stated["position"], stated["velocity"]
    told = f"position {away[0]:.1e} of {claimed[0]:.1e}, velocity {away[1]:.1e} of {claimed[1]:.1e}"
    granted = (ROUNDING * growth * fastest + reference["error"][0], ROUNDING * growth * fastest + reference["error"][1])
    loose = LOOSE, LOOSE * fastest
    if all(a <= c + g for a, c, g in zip(away, claimed, granted)):
        return ("loosely" if any(c > limit for c, limit in zip(claimed, loose)) else "agrees"), told
    return ("beyond" if away[0] <= loose[0] and away[1] <= loose[1] else "WRONG"), told


def integrators(rng, system, t, fastest):
    yield "cvode", 'scheme = "cvode"'
    yield "arkode", 'scheme = "arkode"'
    through = min(system.widths) / fastest
    longest = min(t, 0.9 / abs(system.field) if system.field else t)  # walls are searched along steps that do not turn far
    for name, share in SCHEMES:
        sensible = min(longest, max(share * through, t / 1e6))
        yield name, f'scheme = "{name}"\nstep = {sensible!r}'
        yield f"{name}, long", f'scheme = "{name}"\nstep = {min(longest, through * 2 * 50 ** rng.random())!r}'
    yield "chosen", ""


class Trial:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.counts, self.failed = collections.defaultdict(collections.Counter), 0
        self.references, self.precise = 0, 0

    def note(self, index, system, mode, verdict, told=""):
        self.counts[mode][verdict] += 1
        expected = verdict == "agrees" or (verdict == "loosely" and mode == "chosen")
        bad = verdict in SILENT or (mode in ("chosen", "ensemble") and not expected)
        self.failed += bad
        if bad or verdict == "no reference":
            print(f"{index} ({system.family}), {mode}: {verdict} {told[:200]}", flush=True)
        return bad

    def file(self, index, text):
        path = self.folder / f"{self.options.seed}-{index}.toml"
        path.write_text(text)
        return path

    def one(self, index):
        system = System(self.options.seed, index)
        if self.options.escape:
            file = self.file(index, system.toml(ensemble=True))
            run = ask(file, ["escape", "--trajectories", "200", "--threads", "1"])
            return self.note(index, system, "ensemble", "agrees" if run["exit"] == 0 else "refused", run["messages"])
        compared = ask(self.file(index, system.toml()), ["compare", "--schemes", "cvode", "--tolerances", "1e-3"])
        if "reference" not in compared:
            return self.note(index, system, "reference", "no reference", compared["messages"])
        self.references += 1
        self.precise += "34 digits" in compared["reference"]["scheme"]
        t, fastest, error = compared["t"], max(1.0, compared["speed"]), compared["reference"]["error"]
        reference = compared["reference"]["end"][0] | {"error": (error * compared["size"], error * compared["speed"])}
        rng = random.Random(f"steps {self.options.seed} {index}")
        for k, (mode, integrator) in enumerate(integrators(rng, system, t, fastest)):
            file = self.file(f"{index}-{k}", system.toml(integrator, t))
            if not self.note(index, system, mode, *verdict_of(ask(file, ["run"]), reference, compared["growth"], t, fastest)):
                file.unlink()

    def report(self):
        print(f"{self.references} references, {self.precise} of them in 34 digits")
        words = sorted({word for count in self.counts.values() for word in count})
        trials.table([["", *words]] + [[mode, *(count[word] for word in words)] for mode, count in self.counts.items()])
        return 1 if self.failed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carom", default=trials.program, help="the program")
    parser.add_argument("--count", type=int, default=200, help="systems")
    parser.add_argument("--seed", type=int, default=1 + trials.shift)
    parser.add_argument("--from", type=int, default=0, dest="first", help="index of the first system")
    parser.add_argument("--escape", action="store_true", help="ensembles in place of runs")
    parser.add_argument("--keep", help="a folder for the files of runs that are wrong in silence")
    parser.add_argument("--quick", action="store_true", help="few systems")
    options = parser.parse_args()
    trials.program = options.carom
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(options.keep or name)
        folder.mkdir(exist_ok=True)
        trial = Trial(options, folder)
        for index in range(options.first, options.first + (14 if options.quick else options.count)):
            trial.one(index)
        return trial.report()


if __name__ == "__main__":
    sys.exit(main())
