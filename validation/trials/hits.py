"""Many hits in all closed built-in systems with free flights: no particle is lost, none wrongly singular.

Each system is flown with --closed (lattices and the disc gas are closed anyway) by trajectories of
10^5 hits, and its share of --hits is split evenly; thin and small walls, whose hits cost an exact
decision each, take a tenth to 10^-5 of it. Expected: lost, unresolved and singular 0, and as many
hits as were asked for. --hits 1e11 takes a quarter of an hour of one core with AVX-512.
"""

import argparse
import pathlib
import sys
import tempfile

import trials

SYSTEMS = [
    "stadium",
    "circle",
    "sinai",
    "mushroom",
    "lorentz-square",
    "lorentz-triangular",
    "magnetic-square",
    "siam-photon",
    "ellipse-magnetic",
]
SQUARE = "[table]\nshape = \"polygon\"\npoints = [[0, 0], [3, 0], [3, 3], [0, 3]]\n"
END = "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n[run]\ntrajectories = 1\nt_max = 1\n"
FIELD = "[field]\nlarmor_radius = 2\n"


def ellipse(b):
    return SQUARE + f"[[table.obstacle]]\nshape = \"ellipse\"\ncenter = [1.5, 1.5]\na = 1.4\nb = {b}\n"


def disc(radius):
    return SQUARE + f"[[table.obstacle]]\nshape = \"circle\"\ncenter = [1.5, 1.5]\nradius = {radius}\n"


# name, system file, share of what a built-in system takes
THIN = [
    ("ellipse b = 1e-3", ellipse(1e-3), 0.01),
    ("ellipse b = 1e-7", ellipse(1e-7), 1e-4),
    ("ellipse b = 1e-7, field", ellipse(1e-7) + FIELD, 1e-5),
    ("disc of radius 1e-8", disc(1e-8), 0.03),
    ("disc of radius 1e-8, field", disc(1e-8) + FIELD, 0.03),
    ("rectangle 1 x 1e-9", "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1e-9\n", 0.1),
    ("stadium, radius 1e-6", "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1e-6\n", 0.01),
    ("mushroom, stem 1e-9", "[table]\nshape = \"mushroom\"\ncap_radius = 1\nstem_width = 1e-9\nstem_height = 1\n", 0.1),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--carom", default=trials.program)
    parser.add_argument("--hits", type=float, default=1e10)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    trials.program = args.carom
    rows = [("system", "hits", "ns", "exact", "lost", "unresolved", "singular")]
    bad, total = [], 0
    with tempfile.TemporaryDirectory() as folder:
        work = [(name, name, 1.0) for name in SYSTEMS]
        for number, (name, text, share) in enumerate(THIN):
            path = pathlib.Path(folder) / f"{number}.toml"
            path.write_text(text + END)
            work.append((name, str(path), share))
        each = args.hits / sum(share for _, _, share in work)
        for number, (name, system, share) in enumerate(work):
            length = 1e5 if share == 1.0 else 1e3
            count = max(100, round(each * share / length))
            got = trials.carom(
                f"escape {system} --closed --collisions {length:.0f} --t-max 1e300 "
                f"--trajectories {count} --threads {args.threads} --seed {900 + number}"
            )
            total += got["collisions"]
            rows.append((
                name,
                f"{got['collisions']:.4g}",
                f"{1e9 * got['cpu_seconds'] / max(1, got['collisions']):.1f}",
                got["decisions"]["exact"],
                got["lost"],
                got["unresolved"],
                got["singular"],
            ))
            if got["lost"] or got["unresolved"] or got["singular"] or got["collisions"] != length * count:
                bad.append(name)
            print(*rows[-1], sep="  ", file=sys.stderr, flush=True)
    trials.table(rows)
    print(f"{total:.4g} hits")
    if bad:
        sys.exit("not as expected: " + ", ".join(bad))


if __name__ == "__main__":
    main()
