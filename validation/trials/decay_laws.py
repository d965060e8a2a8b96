#!/usr/bin/python3
"""Laws of decay: the right one is found, none has a plateau that is not there, and intervals of 95 % hold.

1. Made-up ensembles of eight laws, 110 000 particles each. Expected: the law is found in 95 % or more; the intervals of its rate
   or exponent, amplitude and plateau hold in 92 to 98 %.
2. Ensembles of 2e4, 2e5 and 2e6 particles drawn from the survival curve of one large run of the program each: stadiums with half
   lengths 2 and 1, a stadium with two holes, and the circle, until several times. All decay as 1/t. Expected: a plateau is decided
   in 3 % or less; where an exponent is printed that is not called a local slope, its interval holds 1 in 92 % or more of all together.
3. The same of a mushroom, whose share that stays is known. Expected: a plateau is found in half of the ensembles or more, and the
   interval of a decided one holds in 92 % or more.
4. The program itself, stadium and circle, 2e4 trajectories with 40 seeds. Expected as of 2.

    decay_laws.py [--carom PATH] [--fits PATH] [--quick]

Curves of runs have errors of their own: that of 2e7 particles adds .05 to an error of 2e6 (2e6 and --quick: .4).
"""
import argparse
import os
import subprocess
import sys
import tempfile

import h5py
import numpy
import trials
from trials import carom, table, wilson

PER_OCTAVE = 64  # bins of times, as of an archive
LEAST = 20  # intervals that tell a coverage

exp = numpy.exp


def power(t, a, first=1.0):
    return (numpy.maximum(t, first) / first) ** -a


def delayed(t):
    return numpy.where(t < 2, 1.0, (0.5 * exp(-0.1 * (t - 2)) - 0.1 * exp(-0.5 * (t - 2))) / 0.4)


# P(t), the end of the run, the law, its rate or exponent, A, and the share that stays.
LAWS = {
    "exp(-0.1 t)": (lambda t: exp(-0.1 * t), 200, "exponential", 0.1, 1.0, 0.0),
    "t^-1.5": (lambda t: power(t, 1.5), 1000, "power", 1.5, 1.0, 0.0),
    "0.9 exp(-0.1 t) + 0.1": (lambda t: 0.9 * exp(-0.1 * t) + 0.1, 200, "exponential + plateau", 0.1, 0.9, 0.1),
    "0.95/t + 0.05": (lambda t: 0.95 * power(t, 1) + 0.05, 1000, "power + plateau", 1.0, 0.95, 0.05),
    "two exponentials": (lambda t: 0.5 * exp(-t / 3) + 0.5 * exp(-0.1 * t), 200, "exponential", 0.1, 0.5, 0.0),
    "a delay": (delayed, 300, "exponential", 0.1, numpy.exp(0.2) * 0.5 / 0.4, 0.0),
    "exponential, 0.24/t": (lambda t: 0.97 * exp(-0.2 * t) + 0.03 * power(t, 1, 8.0), 3000, "power", 1.0, 0.24, 0.0),
    "1/(1 + t)": (lambda t: 1 / (1 + t), 1000, "power", 1.0, 1.0, 0.0),
}
TWO_HOLES = 'table.hole=[{wall="bottom",center=2,width=0.4},{wall="top",center=1,width=0.4}]'
# Arguments, the ends of runs. They are ends of bins.
RUNS = {
    "stadium, half length 2": (["stadium"], (304, 608, 1000, 1600, 4992)),
    "stadium, half length 1": (
        ["stadium", "--set", "table.half_length=1", "--set", 'table.hole=[{wall="bottom",center=1,width=0.4}]'],
        (304, 1000, 4992),
    ),
    "stadium, two holes": (["stadium", "--set", TWO_HOLES], (304, 1000, 4992)),
    "circle": (["circle"], (100, 400)),
}
MUSHROOM_STAYS = 0.2389084  # without the particles that leave: 1 - .7610915953


def edges_until(until):
    edges = [2.0**octave * (1 + j / PER_OCTAVE) for octave in range(-5, 60) for j in range(PER_OCTAVE) if 2.0**octave < until]
    return numpy.append([edge for edge in edges if edge < until], until)


def curve_of(words, until, particles, folder):
    """P(t) of one run, at the ends of its bins."""
    file = os.path.join(folder, "run.h5")
    carom([*words, "--trajectories", str(particles), "--t-max", str(until), "--seed", "77", "-o", file, "--force"])
    with h5py.File(file) as archive:
        at, gone = archive["escape_times/from"][:], archive["escape_times/gone"][:]
        there = int(archive["fates/survived"][()])
    left = numpy.append(there + numpy.cumsum(gone[::-1])[::-1], there) / (there + gone.sum())
    return lambda t: left[numpy.searchsorted(at, numpy.asarray(t) * (1 - 1e-12))]


def fits_of(options, p, until, particles, count, seed=1):
    """Fits of ensembles that are drawn from P(t): None, or (decided, local, from, to, laws)."""
    generator = numpy.random.default_rng(seed + trials.shift)
    edges = edges_until(until)
    left = numpy.array(p(edges), dtype=float)
    left[0] = 1.0
    shares = numpy.clip(numpy.append(-numpy.diff(left), left[-1]), 0, None)
    shares /= shares.sum()
    lines = []
    for _ in range(count):
        gone = generator.multinomial(particles, shares)
        escapes = " ".join(f"{t} {n}" for t, n in zip(edges[:-1], gone[:-1]) if n)
        lines.append(f"{particles} {gone[-1]} {until} 0 0 {escapes}")
    done = subprocess.run([options.fits], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    found = []
    for words in (line.split("\t") for line in done.stdout.splitlines()):
        if words[0] == "none":
            found.append(None)
            continue
        laws = [(words[i], *map(float, words[i + 1 : i + 8])) for i in range(4, len(words), 8)]
        found.append((words[0] == "decided", words[1] == "local", float(words[2]), float(words[3]), laws))
    return found


def holds(value, error, truth):
    return abs(value - truth) <= 1.96 * error


def share(held, of):
    return f"{held / of:.3f}" if of else ""


def inside(held, of, low, high):
    """Is the coverage within a range, as far as so few tell?"""
    if of < LEAST:
        return True
    at_least, at_most = wilson(held, of)
    return at_most >= low and at_least <= high


def made_up(options):
    rows, good = [["made by", "found", "lasting", "rate or exponent", "A", "plateau", ""]], True
    count = 100 if options.quick else 1000
    for name, (p, until, law, rate, amplitude, plateau) in LAWS.items():
        right = [fit for fit in fits_of(options, p, until, 110000, count) if fit and fit[4][0][0] == law]
        best = [fit[4][0] for fit in right]
        held = [
            sum(holds(one[1], one[2], rate) for one in best),
            sum(holds(one[3], one[4], amplitude) for one in best),
            sum(holds(one[5], one[6], plateau) for one in best) if plateau else 0,
        ]
        fine = len(right) >= 0.95 * count and all(inside(k, len(best), 0.92, 0.98) for k in held[: 3 if plateau else 2])
        good = good and fine
        shares = [share(k, len(best)) for k in held]
        rows.append([name, len(right), sum(not fit[1] for fit in right), *shares[:2], shares[2] if plateau else "", "" if fine else "!"])
    table(rows)
    return good


def judged(found):
    """Ensembles that decide for a plateau; exponents that are no local slopes, and those that hold 1; kinds of the rest."""
    plateaus = sum(bool(fit and fit[0] and "plateau" in fit[4][0][0]) for fit in found)
    lasting = [fit[4][0] for fit in found if fit and not fit[1] and fit[4][0][0] == "power"]
    exponentials = sum(bool(fit and not fit[1] and fit[4][0][0] == "exponential") for fit in found)
    local = sum(bool(fit and fit[1]) for fit in found)
    return plateaus, len(lasting), sum(holds(one[1], one[2], 1.0) for one in lasting), exponentials, local, found.count(None)


HEAD = ["drawn from", "t_max", "particles", "plateau decided", "exponent", "holds 1", "exponential", "local slope", "none", ""]


def drawn(options, folder):
    rows, good, count = [HEAD], True, 40 if options.quick else 200
    lasting = held = 0
    for name, (words, ends) in RUNS.items():
        p = curve_of(["escape", *words], max(ends), 2000000 if options.quick else 20000000, folder)
        for until in ends:
            for particles in (20000, 200000) if options.quick else (20000, 200000, 2000000):
                plateaus, *rest = judged(fits_of(options, p, until, particles, count))
                fine = plateaus <= 0.03 * count
                good = good and fine
                lasting += rest[0]
                held += rest[1]
                rows.append([name, until, particles, plateaus, rest[0], share(rest[1], rest[0]), *rest[2:], "" if fine else "!"])
    rows.append(["all", "", "", "", lasting, share(held, lasting), "", "", "", ""])
    table(rows)
    return good and inside(held, lasting, 0.92, 1.0)


def plateaus(options, folder):
    rows, count = [["drawn from", "t_max", "particles", "plateau found", "decided", "P_infinity holds", ""]], 40 if options.quick else 200
    p = curve_of(["escape", "mushroom"], 992, 300000 if options.quick else 2000000, folder)
    good = True
    for until in (304, 992):
        found = [fit for fit in fits_of(options, p, until, 20000, count) if fit and "plateau" in fit[4][0][0]]
        decided = [fit[4][0] for fit in found if fit[0]]
        held = sum(holds(one[5], one[6], MUSHROOM_STAYS) for one in decided)
        fine = len(found) >= 0.5 * count and inside(held, len(decided), 0.92, 1.0)
        good = good and fine
        rows.append(["mushroom", until, 20000, len(found), len(decided), share(held, len(decided)), "" if fine else "!"])
    table(rows)
    return good


def real(options):
    rows, good = [["run", "seeds", "plateau decided", "exponent", "holds 1", ""]], True
    seeds = 10 if options.quick else 40
    for name in ("stadium", "circle"):
        fits = [carom(["escape", name, "--trajectories", "20000", "--seed", str(seed)])["fit"] for seed in range(1, seeds + 1)]
        fits = [fit for fit in fits if fit["model"]]
        decided = sum("plateau" in fit["model"] and fit["decided"] for fit in fits)
        lasting = [fit for fit in fits if fit["model"] == "power" and not fit["local_slope"]]
        held = sum(holds(fit["exponent"], fit["stderr"], 1.0) for fit in lasting)
        fine = decided <= 0.03 * seeds and inside(held, len(lasting), 0.92, 1.0)
        good = good and fine
        rows.append([name, seeds, decided, len(lasting), share(held, len(lasting)), "" if fine else "!"])
    table(rows)
    return good


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--carom", default=trials.program)
    parser.add_argument("--fits", default="build/release/validation/trials/decay_fits")
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    trials.program = options.carom
    with tempfile.TemporaryDirectory() as folder:
        good = [made_up(options), drawn(options, folder), plateaus(options, folder), real(options)]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
