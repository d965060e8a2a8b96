#!/usr/bin/env python3
"""Draws the section stored by `carom section`: s against v_parallel, one colour an orbit.

    docs/figures/section.py section.h5 section.svg

Walls are put one after the other; sections by a velocity are drawn as x against y.
"""
import pathlib
import sys

import h5py
import numpy as np

WIDTH, HEIGHT, MARGIN = 900.0, 560.0, 40.0
COLOURS = ["#2a6fbb", "#d1495b", "#edae49", "#00798c", "#5b3a8c", "#66a182", "#2e4057", "#b5651d"]


def main(archive, output):
    with h5py.File(archive) as file:
        rows = file["section"]
        orbit, wall, direction = rows["orbit"][:], rows["wall"][:], rows["direction"][:]
        s, v = rows["s"][:], rows["v_parallel"][:]
        names = ("s", "v_parallel")
        if not np.any(wall >= 0) and not np.any(s) and not np.any(v):
            s, v, names = rows["x"][:], rows["y"][:], ("x", "y")
        else:
            # Without the walls' lengths at hand: the largest s of each.
            start = 0.0
            for number in range(int(wall.max(initial=-1)) + 1):
                here = wall == number
                length = s[here].max(initial=0.0)
                s[here] += start
                start += length
    if len(s) == 0:
        sys.exit(f"{archive} holds no points")
    low, high = np.array([s.min(), v.min()]), np.array([s.max(), v.max()])
    scale = np.array([WIDTH, HEIGHT]) / np.where(high > low, high - low, 1.0)
    x = MARGIN + (s - low[0]) * scale[0]
    y = MARGIN + (high[1] - v) * scale[1]
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH + 2 * MARGIN:.0f} '
             f'{HEIGHT + 2 * MARGIN:.0f}">', f"<title>Section of {len(set(orbit))} orbits, {len(s)} points</title>",
             '<rect width="100%" height="100%" fill="white"/>',
             f'<rect x="{MARGIN}" y="{MARGIN}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#1b2a41"/>']
    for k, which in enumerate(sorted(set(orbit))):
        here = orbit == which
        dots = "".join(f"M{a:.1f},{b:.1f}h0" for a, b in zip(x[here], y[here]))
        lines.append(f'<path d="{dots}" stroke="{COLOURS[k % len(COLOURS)]}" stroke-width="1.1" '
                     'stroke-linecap="round" fill="none"/>')
    text = 'font-family="sans-serif" font-size="15" fill="#1b2a41"'
    lines += [f'<text x="{MARGIN}" y="{HEIGHT + 1.6 * MARGIN:.0f}" {text}>{names[0]}: {low[0]:.3g} to {high[0]:.3g}'
              f'{"" if not np.any(direction) else ", both directions" if len(set(direction)) > 1 else ""}</text>',
              f'<text x="{MARGIN}" y="{0.7 * MARGIN:.0f}" {text}>{names[1]}: {low[1]:.3g} to {high[1]:.3g}</text>',
              "</svg>"]
    pathlib.Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
