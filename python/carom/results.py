"""Results: attributes are named as the keys of the program's JSON. Units are those of the system:
lengths, times and masses as its file means them."""

import decimal
import warnings
from typing import Any, Optional

import numpy

from . import _carom, plot
from ._carom import counted
from .errors import InputError
from .records import Record, Report, Rows, table_of
from .stored import OfSystem, Result


def _rows(array):
    return None if array is None else array.view(Rows)


class Table(OfSystem):
    """A table with its measures.

    area (length²; of one cell of a lattice, "inf" in the open plane), perimeter and mean_flight
    (length; π·area/perimeter), shape. Arrays:

    walls   (number of walls,): name, kind, length (length), from and to (length, two numbers each),
    of arcs center and radius (length; of ellipses a, b and the direction axis) and angles
    holes   (number of holes,): name, wall, center and width (length, along the wall)
    """

    _COLUMNS = {
        "walls": [("name", "U1"), ("kind", "U1"), ("length", "f8"), ("from", "f8", (2,)), ("to", "f8", (2,))],
        "holes": [("name", "U1"), ("wall", "U1"), ("center", "f8"), ("width", "f8")],
    }

    @property
    def walls(self) -> numpy.ndarray:
        """(number of walls,): as above; NaN where a wall has no such number (length, radians)."""
        rows = self._json["walls"]
        return table_of(rows) if rows else numpy.empty(0, self._COLUMNS["walls"]).view(Rows)

    def _pictures(self):
        return {"table": lambda of, **keywords: plot.table(of.system, **keywords)}

    def _summary(self):
        return f"{self.shape}, {counted(len(self.walls), 'wall')}, {counted(len(self.holes), 'hole')}"

    def _main(self):
        return [{**wall} for wall in self._json["walls"]]


class Validation(Report):
    """Cases that check the engine against identities and published values.

    passed, failed: numbers of cases. cases (number of cases,): name, passed, value, error,
    expected, sigma (difference in standard errors), source … in the units of each case.
    """

    def _pictures(self):
        return {"distances": plot.distances}

    def _summary(self):
        return f"{self.passed} passed, {self.failed} failed"

    def _main(self):
        return self._json["cases"]


class Splitting(OfSystem):
    """Survival far beyond what an ensemble reaches, by populations whose survivors are copied.

    survival (levels in time) or survival_hits (levels in hits), and rate: a row has value, stderr,
    extrapolation, kick_error, low, high (95 %), at_kicks; t is a time, n a number of hits, rates are
    fractions per time. fit: the decay at late times or hits, as in `carom.Escape`.
    """

    def _pictures(self):
        return {"survival": plot.splitting}

    def _summary(self):
        return f"{self.levels}, {counted(self.repetitions, 'population')} of {self.population}"

    def _main(self):
        return self._json["survival" if self.levels == "time" else "survival_hits"]


_PER_TRAJECTORY = """One row for each particle, with per_trajectory=True; else None.

        (trajectories × particles,): index; x, y (length) and vx, vy (length/time) of the start;
        fate (its name is carom.fates[fate]); hole (−1: none); time of the end (time); hits; wall
        (−1: none), s (length) and v_parallel (length/time) of a start on a wall, else NaN."""


class Escape(Result, archive="escape"):
    """Survival and escape. trajectories, escaped, survived, collisions, digest … Arrays:

    survival       (number of times,): t (time), p, low, high (share, 95 % interval)
    survival_hits  (number of counts,): n, p, low, high: the fraction still inside after n hits
    rate           (number of times,): t, from, to (time), value, low, high (1/time): −dp/dt
    holes          (number of holes,): name, escaped, p, low, high (share, 95 % interval)

    fit, fit_hits: the likeliest decay at late times, and by number of hits. model, rate (1/time) or exponent, stderr, amplitude,
    plateau, p_value, window (time), decided, alternatives; local_slope: the rate is that of the window, which
    alone does not show a law; model is None where `reason` says why.
    """

    _COLUMNS = {
        "holes": [("name", "U1"), ("escaped", "i8"), ("p", "f8"), ("low", "f8"), ("high", "f8")]
    }

    def _pictures(self):
        more = {"basins": plot.basins, "times": plot.times} if self.per_trajectory is not None else {}
        return {"survival": plot.escape, "rate": plot.rate} | more

    def _summary(self):
        return f"{counted(self.trajectories, 'trajectory')}, {self.escaped} escaped, {self.survived} survived"

    def _main(self):
        return self.survival

    @property
    def per_trajectory(self) -> Optional[numpy.ndarray]:
        return _rows(self._outcome.trajectories())

    per_trajectory.__doc__ = _PER_TRAJECTORY


class Diffusion(Result, archive="diffusion"):
    """Mean square displacements.

    D (value, stderr: length²/time; None where it does not exist), exponent and local_exponent
    (value, stderr), window (time). Arrays, (number of times,) each:

    msd            t (time), value, stderr (length²)
    fourth_moment  t (time), value, stderr (length⁴)
    correlation    t (time), value, stderr (length²/time²): ⟨v(t)·v(0)⟩
    green_kubo     t (time), value, stderr (length²/time): half its integral from 0 to t

    free_paths (with free_paths=True): mean (length: value, stderr), limit, between_hits and at_start
    with bins, (number of bins,): from, to (length), count, density (1/length), longer (share) …
    """

    def _pictures(self):
        more = {"free_paths": plot.free_paths} if "free_paths" in self._json else {}
        return {"diffusion": plot.diffusion, "correlation": plot.correlation} | more

    def _summary(self):
        return f"{counted(self.trajectories, 'trajectory')}, D = {self.D}"

    def _main(self):
        return self.msd


class Lyapunov(Result, archive="lyapunov"):
    """Lyapunov exponents and chaotic orbits.

    ``lambda_`` (value, stderr: 1/time; the largest first) and per_collision (value, stderr: a hit) are
    lists, of zeros where `law` is "linear", None where `reason` says why; chaotic_share (value, stderr,
    low, high, hidden; None where `no_share` says why), chaotic_lambda, regularity, window (time). Of an open
    table they are those of the orbits that never leave, and repeller says how they were measured. Array:

    distribution  (number of bins,): from, to (1/time), count: finite-time exponents of the orbits
    convergence   (number of times,): t (time), lambda, lambda_stderr (1/time): the exponent since the start

    With spectrum=True also entropy (value, stderr: 1/time), pairing (1/time), zeros (count, laws,
    largest) and the array

    spectrum      (4 · number of particles,): value, stderr (1/time), the largest first
    """

    _COLUMNS = {
        "distribution": [("from", "f8"), ("to", "f8"), ("count", "i8")],
        "convergence": [("t", "f8"), ("lambda", "f8"), ("lambda_stderr", "f8")],
    }

    @property
    def lambda_(self):
        """The key ``lambda``, which is a word of Python."""
        return getattr(self, "lambda")

    @property
    def per_trajectory(self) -> Optional[numpy.ndarray]:
        return _rows(self._outcome.trajectories())

    per_trajectory.__doc__ = _PER_TRAJECTORY.replace(
        "else NaN.",
        """else NaN;
        lambda (1/time): its finite-time exponent, NaN where it ended before it was measured; sali:
        the angle between two deviations; regularity: 0 linear
        growth (regular where `regularity.regular` is not 0), 1 chaotic, 2 undecided.""",
    )

    def _pictures(self):
        rows = self.per_trajectory
        more = {} if rows is None else {"exponents": plot.exponents}
        more |= {"times": plot.times} if rows is not None and numpy.ptp(rows["time"]) > 0 else {}
        whole = {"spectrum": plot.spectrum} if "spectrum" in self._json else {}
        pictures = {"lyapunov": plot.lyapunov} if self._json["distribution"] else {}
        growing = {"convergence": plot.convergence}
        return (growing | pictures if self.orbits == 1 else pictures | growing) | whole | more

    def _summary(self):
        largest = self.lambda_[0] if self.lambda_ is not None else None
        return f"{counted(self.orbits, 'orbit')}, lambda = {largest}"

    def _main(self):
        return self.distribution


class Run(Result, archive="run"):
    """One trajectory, of one or several particles.

    status, collisions, t (time), x, y (length), vx, vy (length/time) of the end,
    trusted_collisions; of several particles `particles`, a record of these for each.
    """

    @property
    def hits(self) -> numpy.ndarray:
        """Reflections in order of time, (number of hits,), not copied and not to be written.

        particle, wall (index into system.walls), s (length, along the wall), v_parallel
        (length/time, along the wall), t (time), x, y (length, in the plane), vx, vy (length/time)
        after the hit, cell_first, cell_second (cell of the lattice), reflections (1, or n at a
        corner of angle π/n).
        """
        return self._outcome.hits().view(Rows)

    @property
    def samples(self) -> numpy.ndarray:
        """States at the times of `sample`, (times × particles,).

        particle, t (time), x, y (length, in the plane), vx, vy (length/time), cell_first,
        cell_second.
        """
        return self._asked_for(self._samples)

    @property
    def _samples(self):
        return self._outcome.samples().view(Rows)

    def _asked_for(self, rows):
        """The same; where they are none because `sample=` was not given, with a warning."""
        if not len(rows) and not len(self._samples):
            warnings.warn("no samples are stored: carom.run(…, sample=0.1) stores the state at every 0.1 of time",
                          stacklevel=3)  # fmt: skip
        return rows

    @property
    def contacts(self) -> numpy.ndarray:
        """Contacts of hard discs in order of time, (number of contacts,).

        first, second (particles, first < second), t (time), first_x, first_y, second_x, second_y
        (length, centres in the plane), dx, dy (length, from the second to the first, of the copies
        that touch), first_vx, first_vy, second_vx, second_vy (length/time) after the contact,
        transfer (momentum along the line of centres).
        """
        return self._outcome.contacts().view(Rows)

    @property
    def energies(self) -> numpy.ndarray:
        """Sums over the particles at the times of `sample`, (times,); empty without forces or
        hard discs.

        t (time), kinetic, external, pair, total (energy), px, py (momentum), angular_momentum
        (about the origin).
        """
        return self._asked_for(self._energies)

    @property
    def _energies(self):
        return self._outcome.energies().view(Rows)

    @property
    def starts(self) -> numpy.ndarray:
        """The start of each particle, (particles,): columns and units (time, length, length/time) as
        of `samples`."""
        return self._outcome.starts().view(Rows)

    def path(self, particle: int = 0) -> numpy.ndarray:
        """Points along the orbit of a particle, (points,): t (time), x, y (length, in the plane).
        Arcs have points between their ends. Where forces act: its samples and hits."""
        if particle not in self.starts["particle"]:
            raise InputError(f"there is no particle {particle!r}", ("", 0, 0, "particle"), "its index, from 0 on")
        return _carom.path(self._outcome.system, particle, self.engine == "events", self._states(particle))

    def _states(self, particle):
        """Rows of (t, x, y, vx, vy, wall or -1): start, samples where forces act, hits, contacts, end."""
        rows = [self.starts[self.starts["particle"] == particle]]
        names = ["t", "x", "y", "vx", "vy"]
        if self.engine != "events":
            rows.append(self._samples[self._samples["particle"] == particle])
        rows.append(self.hits[self.hits["particle"] == particle])
        parts = [numpy.stack([*(r[n] for n in names), numpy.full(len(r), -1)], axis=1) for r in rows]
        parts[-1][:, 5] = rows[-1]["wall"]
        for which in ("first", "second"):
            met = self.contacts[self.contacts[which] == particle]
            columns = ["t", *(f"{which}_{name}" for name in names[1:])]
            parts.append(numpy.stack([*(met[name] for name in columns), numpy.full(len(met), -1)], axis=1))
        table = numpy.concatenate(parts)
        end = self._json if "x" in self._json else self._json["particles"][particle]
        last = [*(float(end[name] or 0) for name in names), -1]
        table = numpy.concatenate([table[table[:, 0] <= last[0]], [last]])
        return table[numpy.argsort(table[:, 0], kind="stable")]

    def _pictures(self):
        return {"orbit": plot.orbit} | ({"energy": plot.energy} if len(self._energies) else {})

    def _summary(self):
        return f"{self.status}, {counted(self.collisions, 'collision')}"

    def _main(self):
        return self.hits


class Comparison(Result, archive="compare"):
    """Integrators compared on a system.

    t (time) of the comparison, growth (share) of small errors until then, size (length) and speed
    (length/time), the units of error_state; reference; error (share) that is wanted, cheapest and
    fastest for it.
    """

    @property
    def schemes(self) -> numpy.ndarray:
        """A row for each run, (runs,): scheme, step (time) or tolerance, order, error_state (share),
        error_position (length), error_velocity (length/time), error_energy (share),
        error_reversal (share), steps, force_evaluations, cpu_seconds (s), failure ("": none). What
        is not known is NaN."""
        return table_of(self._json["schemes"])

    @property
    def measured(self) -> numpy.ndarray:
        """A row for each scheme, (schemes,): scheme, stated and measured order, order_error, from and
        to (time, the steps that it rests on), reason ("": none), reversible and symplectic (1 or 0),
        areas and areas_error (share) … What is not known is NaN."""
        return table_of(self._json["measured"], unknown=("reversible", "symplectic"))

    def _pictures(self):
        return {"comparison": plot.comparison}

    def _summary(self):
        cheapest = self._json["cheapest"]
        best = "none" if cheapest is None else cheapest["scheme"]
        return f"{counted(len(self._json['measured']), 'scheme')}, cheapest for {self.error:.1g}: {best}"

    def _main(self):
        return self.schemes


class Exact(decimal.Decimal):
    """A number whose printed digits are guaranteed; `digits` of them are decimals, `interval`
    encloses the true number. Unit: that of the quantity."""

    digits: int

    def __new__(cls, text, digits):
        made = super().__new__(cls, text)
        made.digits = digits
        return made

    @property
    def interval(self) -> tuple[decimal.Decimal, decimal.Decimal]:
        """(low, high): the true number lies between them."""
        with decimal.localcontext() as context:
            context.prec = max(28, len(self.as_tuple().digits) + 4)
            error = decimal.Decimal(1).scaleb(-self.digits)
            return self - error, self + error

    def __reduce__(self):
        return Exact, (str(self), self.digits)


class Certified(Result, archive="certified"):
    """A certified run: t (time), x, y (length), vx, vy (length/time) are `Exact`; status,
    collisions, digits, bits, lost_bits."""

    def _summary(self):
        return f"{self.status}, {counted(self.collisions, 'collision')}, {counted(self.digits, 'digit')}"

    def __getattr__(self, key: str) -> Any:
        value = super().__getattr__(key)
        return Exact(value, self._json["digits"]) if key in ("t", "x", "y", "vx", "vy") else value

    @property
    def hits(self) -> list[Record]:
        """A record for each hit, (collisions,): number (from 1), wall (its name), and after it t
        (time), x, y (length), vx, vy (length/time), all `Exact`."""
        digits = self._json["digits"]
        names = ("t", "x", "y", "vx", "vy")
        return [
            Record({"number": n, "wall": wall} | dict(zip(names, (Exact(v, digits) for v in values))))
            for n, wall, *values in self._outcome.hits()
        ]

    def _main(self):
        return [dict(hit.__dict__) for hit in self.hits]

    def plot(self, ax=None, **keywords):
        """Raises NotImplementedError: the same run in doubles has a picture."""
        raise NotImplementedError("a certified run has no picture; draw carom.run(…) in doubles")


class Orbits(Result, archive="orbit"):
    """Periodic orbits, each listed once, without other starts, its reversal and symmetric copies.

    orbits (number of orbits,): records with hits, period (time), length (length), action (mass ·
    length²/time), trace, stability, multipliers, maslov, family, copies, reduced, word, walls, points; of these
    (hits,): wall, s (length), v_parallel, x, y, vx, vy, flight_time (time)

    zeta (with zeta=True): escape_rate (1/time), error, lambda (1/time), lambda_error, orders

    words, recurrences, unsolved, shadowed: numbers of starts of the search.
    """

    @property
    def paths(self) -> list[numpy.ndarray]:
        """The states of each orbit, (hits + 1, 5): t (time), x, y (length, in the plane), vx, vy
        (length/time), from a hit to itself."""
        return self._outcome.paths()

    def _pictures(self):
        return {"orbits": plot.orbits}

    def _summary(self):
        return f"{counted(len(self.orbits), 'orbit')} of at most {counted(self.most_hits, 'hit')}"

    def _main(self):
        left_out = ("walls", "points", "multipliers", "reduced")
        return [{k: v for k, v in o.items() if k not in left_out} for o in self._json["orbits"]]


class Section(Result, archive="section"):
    """Points of many orbits on a surface: orbits, collisions, digest …"""

    @property
    def points(self) -> numpy.ndarray:
        """Orbit after orbit and in order of time, (points,), not copied and not to be written.

        orbit, index (number in the orbit), particle, wall (index into system.walls, −1: not at a
        wall), direction (1 or −1, 0 at a wall), t (time), s (length, along the wall, line or
        circle), v_parallel (length/time, in the direction of s), x, y (length, in the plane), vx,
        vy (length/time, after the hit at a wall).
        """
        return self._outcome.points().view(Rows)

    def _pictures(self):
        return {"section": plot.section}

    def _summary(self):
        return f"{counted(len(self.points), 'point')} of {counted(self.orbits, 'orbit')}"

    def _main(self):
        return self.points


class Equilibria(Result, archive="relax"):
    """Where all forces vanish. starts, without (numbers of searches). A record each, by rising energy:

    equilibria: energy, energy_error (energy), kind ("minimum", "saddle", "maximum"), descending,
    neutral (numbers of directions), found (starts), position_error (length), positions (length, two
    numbers a particle), walls (names or None), frequencies, growths (1/time)
    """

    def _pictures(self):
        return {"equilibria": plot.equilibria}

    def _summary(self):
        return f"{len(self._json['equilibria'])} from {counted(self.starts, 'start')}"

    def _main(self):
        return self._json["equilibria"]

    @property
    def equilibria(self) -> list[Record]:
        """The equilibria, by rising energy."""
        return [Record(one) for one in self._json["equilibria"]]
