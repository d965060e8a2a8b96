"""Hits and trajectories in blocks of arrays, for analyses of your own."""

import numbers
from typing import Any, Iterator

import numpy

from . import _carom
from .commands import Systems, _as_system
from .errors import InputError, nearest, text_of
from .records import Rows
from .system import OF_A_SYSTEM


def hits(system: Systems, *, block: int = 100_000, **keywords: Any) -> Iterator[numpy.ndarray]:
    """Reflections, an array for each `block` of them, while C++ computes the next ones: for runs too long to keep.

    Columns: trajectory, and those of `carom.Run.hits` (particle, wall, s, v_parallel, t, x, y, vx, vy …), with the
    same bits. Keywords: those of `carom.run`, for the hits of one trajectory, in order of time. With trajectories=1000:
    those of `carom.escape`, and the hits of all, one trajectory after the other.

        for rows in carom.hits(carom.stadium(half_length=1, radius=1), collisions=10**8):
            histogram += numpy.bincount(rows["wall"], minlength=len(histogram))

    Ctrl-C raises KeyboardInterrupt; leaving the loop ends the computation.
    """
    of_all = keywords.get("trajectories") is not None
    loaded = _loaded("hits", "escape" if of_all else "run", system, block, keywords)
    return _taken(_carom.hits(loaded, of_all, block))


def trajectories(system: Systems, *, block: int = 10_000, **keywords: Any) -> Iterator[numpy.ndarray]:
    """Starts and ends of the trajectories of an ensemble, an array for each `block` of particles, in their order.

    Columns: those of `per_trajectory` of `carom.escape` (index, x, y, vx, vy of the start, fate, hole, time, hits …),
    with the same bits, and end_x, end_y (length, in the plane), end_vx, end_vy (length/time) and end_wall: the
    state at t_max, or after the last event of what ended before, and the last wall (−1: none). Keywords:
    those of `carom.escape`.

        for rows in carom.trajectories("stadium", trajectories=10**8, t_max=100):
            counts += numpy.bincount(rows["hole"] + 1, minlength=len(counts))

    Ctrl-C raises KeyboardInterrupt; leaving the loop ends the computation.
    """
    loaded = _loaded("trajectories", "escape", system, block, keywords)
    return _taken(_carom.trajectories(loaded, block))


def _loaded(name, command, system, block, keywords):
    if isinstance(block, bool) or not isinstance(block, numbers.Integral) or not 0 < block <= 10**9:
        raise InputError(f"'block' is {block!r}", ("", 0, 0, "block"), "the number of rows of an array, up to 10^9")
    for key in keywords:
        if key not in OF_A_SYSTEM:
            near = nearest(text_of(key, "keyword"), sorted(OF_A_SYSTEM))
            hint = f"; did you mean '{near}'?" if near else ""
            raise InputError(
                f"carom.{name} has no keyword '{key}'{hint}", ("", 0, 0, key), "a key of a system file", near
            )
    return _as_system(system)._loaded(command, **keywords)


def _taken(stream):
    try:
        while (rows := stream.next()) is not None:
            yield rows.view(Rows)
    finally:
        stream.close()
