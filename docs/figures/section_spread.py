#!/usr/bin/python3
"""How well the orbits of a boundary section keep to curves.

For ten starts of the magnetic ellipse (figure 3 of Solanpaa et al. 2016):

    for x in 0.05 0.145 0.24 0.335 0.43 0.525 0.62 0.715 0.81 0.905; do
      carom run ellipse-magnetic --position $x,0 --velocity 0,1 --collisions 40000 -o orbit-$x.h5
    done
    section_spread.py orbit-*.h5

Each of 400 points is compared with the cubic through its 12 nearest neighbours in the section, across the
direction in which they lie. A regular orbit fills a curve: the distances are of rounding size. A chaotic one
fills an area.
"""
import sys

import h5py
import numpy as np


def distances(s, v, length, sample=400):
    points = np.column_stack([s, v])
    result = []
    for k in np.random.default_rng(1).choice(len(s), sample, replace=False):
        d = points - points[k]
        d[:, 0] -= length * np.round(d[:, 0] / length)
        square = (d**2).sum(1)
        square[k] = np.inf
        near = d[np.argpartition(square, 12)[:12]]
        _, _, axes = np.linalg.svd(near, full_matrices=False)
        along, across = near @ axes[0], near @ axes[1]
        powers = np.column_stack([along**n for n in range(4)])
        result.append(abs(np.linalg.lstsq(powers, across, rcond=None)[0][0]))
    return np.array(result)


for name in sys.argv[1:]:
    with h5py.File(name, "r") as archive:
        hits = archive["collisions"]
        s, v = np.asarray(hits["s"]), np.asarray(hits["v_parallel"])
    d = distances(s, v, s.max())
    print(f"{name}: {len(s)} hits, v_parallel {v.min():+.3f} to {v.max():+.3f}, "
          f"off the curve by {np.median(d):.1e} (median), {d.max():.1e} (largest)")
