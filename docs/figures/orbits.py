#!/usr/bin/env python3
"""Draws the picture of the README from archives of `carom run`.

    docs/figures/orbits.py build/release/carom docs/guide/figures/orbits.svg

Flights are drawn as what they are: lines, and arcs of Larmor circles.
"""
import pathlib
import subprocess
import sys
import tempfile

import h5py

SCALE, MARGIN = 170.0, 14.0
BLUE, RED, WALL = "#2a6fbb", "#d1495b", "#1b2a41"
CAP_RADIUS, STEM, A, B, LARMOR = 1.0, 1.0, 1.0, 0.75, 0.6


def orbit(carom, system, *options):
    """Times and points of the hits of one run."""
    with tempfile.TemporaryDirectory() as folder:
        archive = pathlib.Path(folder) / "orbit.h5"
        subprocess.run([carom, "run", system, *options, "-o", archive, "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
        with h5py.File(archive) as file:
            hits = file["collisions"]
            return list(zip(hits["t"][:], hits["x"][:], hits["y"][:]))


def path(hits, at, radius=None):
    """The flights between hits; with a Larmor radius (speed 1, B > 0) clockwise arcs."""
    t_before, x, y = hits[0]
    words = ["M %.1f,%.1f" % at(x, y)]
    for t, x, y in hits[1:]:
        if radius is None:
            words.append("L %.1f,%.1f" % at(x, y))
        else:
            large = int((t - t_before) / radius > 3.14159265)
            words.append("A %.1f %.1f 0 %d 1 %.1f,%.1f" % (SCALE * radius, SCALE * radius, large, *at(x, y)))
        t_before = t
    return " ".join(words)


def main(carom, output):
    def left(x, y):
        return MARGIN + SCALE * (x + CAP_RADIUS), MARGIN + SCALE * (CAP_RADIUS - y)

    def right(x, y):
        return 2.9 * MARGIN + SCALE * (2 * CAP_RADIUS + A + x), MARGIN + SCALE * (CAP_RADIUS - y)

    closed = ("--set", "table.hole=[]")
    regular = orbit(carom, "mushroom", *closed, "--position", "0.72,0.05", "--velocity", "0.02,1", "--collisions", "60")
    chaotic = orbit(carom, "mushroom", *closed, "--position", "0,-0.5", "--velocity", "0.37,1", "--collisions", "60")
    larmor = orbit(carom, "ellipse-magnetic", "--set", f"field.larmor_radius={LARMOR}", "--position", "0.1,0.2",
                   "--velocity", "1,0.3", "--collisions", "70")
    mushroom = "M %.1f,%.1f L %.1f,%.1f L %.1f,%.1f L %.1f,%.1f A %.1f %.1f 0 0 0 %.1f,%.1f L %.1f,%.1f Z" % (
        *left(-STEM / 2, -1), *left(STEM / 2, -1), *left(STEM / 2, 0), *left(1, 0), SCALE, SCALE, *left(-1, 0),
        *left(-STEM / 2, 0))
    width, height = right(A, 0)[0] + MARGIN, left(0, -1)[1] + MARGIN
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}">',
             '<title>Orbits in a mushroom, and in an ellipse with a magnetic field</title>',
             '<rect width="100%" height="100%" fill="white"/>', '<g fill="none" stroke-linejoin="round">',
             f'<path stroke="{RED}" stroke-width="0.9" d="{path(chaotic, left)}"/>',
             f'<path stroke="{BLUE}" stroke-width="0.9" d="{path(regular, left)}"/>',
             f'<path stroke="{BLUE}" stroke-width="0.9" d="{path(larmor, right, LARMOR)}"/>',
             f'<g stroke="{WALL}" stroke-width="2.5"><path d="{mushroom}"/>',
             '<ellipse cx="%.1f" cy="%.1f" rx="%.1f" ry="%.1f"/></g>' % (*right(0, 0), SCALE * A, SCALE * B),
             "</g>", "</svg>"]
    pathlib.Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
