"""What the searches of `carom relax` find, over seeds.

Wigner molecules of 5, 13 and 19 particles, and 15 and 19 charges in a circle. Expected: no search
ends without an equilibrium; every equilibrium is a minimum; the same energies for all seeds. `found`
over the number of starts is a share of independent starts: over seeds its counts scatter as binomial
numbers do. The sum of their squared distances from the mean, over the binomial variance, follows
chi-squared; intervals of 95 % (Wilson) around each seed's share hold the mean of all seeds in
.92 to .98 of the cases, give or take what their number allows.
"""

import argparse
import math
import sys

import trials

SYSTEMS = [
    ("wigner, 5", ["wigner", "--set", "particles.count=5"], 200),
    ("wigner, 13", ["wigner", "--set", "particles.count=13"], 60),
    ("wigner, 19", ["wigner", "--set", "particles.count=19"], 50),
    ("circle, 15", ["coulomb-circle"], 20),
    ("circle, 19", ["coulomb-circle", "--set", "particles.count=19"], 10),
]


def above(chi, freedom):
    """The probability of a larger chi-squared (Wilson and Hilferty's approximation)."""
    spread = 2 / (9 * freedom)
    z = ((chi / freedom) ** (1 / 3) - (1 - spread)) / math.sqrt(spread)
    return math.erfc(z / math.sqrt(2)) / 2


def searches(words, starts, seeds):
    """Searches without an equilibrium, and for each energy the numbers found by each seed."""
    without, saddles, found = 0, 0, {}
    for seed in range(1, seeds + 1):
        result = trials.carom(
            ["relax", *words, "--starts", str(starts), "--seed", str(seed), "--threads", "1"]
        )
        without += result["without"]
        for one in result["equilibria"]:
            saddles += one["descending"] > 0
            counts = found.setdefault(f"{one['energy']:.9f}", [0] * seeds)
            counts[seed - 1] += one["found"]
    return without, saddles, found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--carom", default=trials.program, help="the program")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--quick", action="store_true", help="below a minute")
    options = parser.parse_args()
    trials.program = options.carom
    seeds = 6 if options.quick else options.seeds
    rows = [["system", "searches", "without", "energy", "share", "chi2/dof", "p"]]
    bad, held, intervals = 0, 0, 0
    for name, words, starts in SYSTEMS[: 3 if options.quick else None]:
        without, saddles, found = searches(words, starts, seeds)
        bad += without + saddles
        for energy, counts in sorted(found.items(), key=lambda one: float(one[0])):
            share = sum(counts) / (starts * seeds)
            chi, p = math.nan, math.nan
            if 5 <= sum(counts) and share < 1:
                chi = sum((k - starts * share) ** 2 for k in counts)
                chi /= starts * share * (1 - share)
                p = above(chi, seeds - 1)
                bad += p < 1e-4 or p > 1 - 1e-4
                for k in counts:
                    low, high = trials.wilson(k, starts)
                    held += low <= share <= high
                    intervals += 1
            cells = [energy, f"{share:.4f}", f"{chi / (seeds - 1):.2f}", f"{p:.3f}"]
            rows.append([name, starts * seeds, without, *cells])
    trials.table(rows)
    low, high = trials.wilson(held, intervals)
    print(f"intervals of 95 % that hold: {held} of {intervals} ({low:.3f} to {high:.3f})")
    return 1 if bad or high < 0.92 or low > 0.98 else 0


if __name__ == "__main__":
    sys.exit(main())
