"""Results: attributes are named as the keys of the program's JSON."""

import decimal
import json
import os
import tempfile

import numpy

from . import _carom
from .errors import InputError


class Record:
    """A few named numbers: `fit.rate`, also `fit["rate"]`."""

    def __init__(self, entries):
        self.__dict__.update({key: _python(value) for key, value in entries.items()})

    def __getitem__(self, key):
        return self.__dict__[key]

    def keys(self):
        return self.__dict__.keys()

    def __repr__(self):
        return "(" + ", ".join(f"{key}={value!r}" for key, value in self.__dict__.items()) + ")"

    def __eq__(self, other):
        return isinstance(other, Record) and repr(self) == repr(other)


def _python(value):
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
        return _table(value)
    return value


def _table(rows):
    """A list of objects with equal keys as a structured array, if they hold numbers and names."""
    first = rows[0]
    kinds = {}
    for key in first:
        column = [row.get(key) for row in rows]
        if all(isinstance(one, bool) for one in column):
            kinds[key] = "?"
        elif all(isinstance(one, int) and not isinstance(one, bool) for one in column):
            kinds[key] = "i8"
        elif all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in column):
            kinds[key] = "f8"
        elif all(isinstance(one, str) for one in column):
            kinds[key] = f"U{max(map(len, column)) or 1}"
        else:
            return [Record(row) for row in rows]
    if any(row.keys() != first.keys() for row in rows):
        return [Record(row) for row in rows]
    return numpy.array([tuple(row.values()) for row in rows], dtype=list(kinds.items()))


def _restored(archive):
    """A result from the bytes of its archive."""
    from .commands import open as open_archive

    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "result.h5")
        with open(file, "wb") as stream:
            stream.write(archive)
        result = open_archive(file)
    result._archive = archive
    return result


class Result:
    """What a command gives. `print(result)` is its report, `result.json` what it says as JSON."""

    def __init__(self, outcome, system):
        self._outcome = outcome
        self._system = system
        self._archive = None  # that it was read from: its name, or its bytes
        self._json = json.loads(outcome.json())

    @property
    def json(self):
        """All keys and values, as the program's --json prints them."""
        return json.loads(self._outcome.json())

    @property
    def system(self):
        """The system that was computed."""
        return self._system

    @property
    def doubts(self):
        """Why the result cannot be trusted, a line each: [] where it can."""
        return self._outcome.doubts()

    def __getattr__(self, key):
        entries = self.__dict__.get("_json")
        if entries is None or key not in entries:
            names = list(entries or ())
            nearest = _carom.nearest_name(key, names)
            hint = f"; did you mean '{nearest}'?" if nearest else ""
            raise AttributeError(f"{type(self).__name__} has no '{key}'{hint}")
        return _python(entries[key])

    def __dir__(self):
        return [*super().__dir__(), *self._json]

    def __str__(self):
        return self._outcome.text() if hasattr(self._outcome, "text") else repr(self)

    def save(self, path, force=False):
        """Writes the archive that the program writes with -o; `force` replaces one."""
        if self._archive is None:
            self._outcome.save(str(path), force)
            return
        if os.path.exists(path) and not force:
            raise InputError(f"{path}: the output file exists already", (str(path), 0, 0, ""))
        archive = self._archive
        if isinstance(archive, str):
            with open(archive, "rb") as stream:
                archive = stream.read()
        with open(path, "wb") as stream:
            stream.write(archive)

    def __reduce__(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "result.h5")
            self.save(file)
            with open(file, "rb") as stream:
                return _restored, (stream.read(),)

    def plot(self, ax=None, **keywords):
        """Draws what there is to see; returns the axes."""
        from . import plot

        return plot.result(self, ax=ax, **keywords)

    def to_dataframe(self):
        """The main table as a pandas.DataFrame."""
        import pandas

        return pandas.DataFrame(self._main())

    def _main(self):
        raise NotImplementedError

    def __repr__(self):
        return f"<carom.{type(self).__name__} of {self._system.name}: {self._summary()}>"

    def _repr_html_(self):
        import html

        return f"<pre>{html.escape(str(self))}</pre>"


class Escape(Result):
    """Survival and escape: `survival`, `rate`, `holes`, `escaped`, `digest` …"""

    def _summary(self):
        return f"{self.trajectories} trajectories, {self.escaped} escaped, {self.survived} survived"

    def _main(self):
        return self.survival

    @property
    def per_trajectory(self):
        """One row a particle with its fate (a number: see carom.fates); None unless asked for."""
        return self._outcome.trajectories()


class Diffusion(Result):
    """Mean square displacement: `msd`, `D`, `exponent` …"""

    def _summary(self):
        return f"{self.trajectories} trajectories, D = {self.D!r}"

    def _main(self):
        return self.msd

    @property
    def per_trajectory(self):
        """One row a particle with its fate (a number: see carom.fates); None unless asked for."""
        return self._outcome.trajectories()


class Run(Result):
    """One trajectory: `hits`, `samples`, `x`, `y`, `status`, `trusted_collisions` …"""

    def __init__(self, outcome, system):
        super().__init__(outcome, system)
        self.hits = outcome.hits()
        self.samples = outcome.samples()
        self.starts = outcome.starts()

    def _summary(self):
        return f"{self.status}, {self.collisions} collisions"

    def _main(self):
        return self.hits

    def path(self, particle=0):
        """Points (t, x, y) along the orbit of a particle: arcs are arcs. Where forces act, its
        samples and hits."""
        rows = [self.starts[self.starts["particle"] == particle]]
        names = ["t", "x", "y", "vx", "vy"]
        if self.engine != "events":
            rows.append(self.samples[self.samples["particle"] == particle])
        rows.append(self.hits[self.hits["particle"] == particle])
        table = numpy.concatenate([numpy.stack([r[n] for n in names], axis=1) for r in rows])
        end = self._json if "x" in self._json else self._json["particles"][particle]
        last = [float(end[name] or 0) for name in names]
        table = numpy.concatenate([table[table[:, 0] <= last[0]], [last]])
        table = table[numpy.argsort(table[:, 0], kind="stable")]
        omegas = _carom.omegas(self._outcome.system)
        omega = omegas[particle] if self.engine == "events" else 0.0
        return _carom.path(table, omega)


class Exact(decimal.Decimal):
    """A number whose printed digits are guaranteed; `interval` encloses the true one."""

    def __new__(cls, text, digits):
        made = super().__new__(cls, text)
        made.digits = digits
        return made

    @property
    def interval(self):
        """(low, high): the true number lies between them."""
        with decimal.localcontext() as context:
            context.prec = max(28, len(self.as_tuple().digits) + 4)
            error = decimal.Decimal(1).scaleb(-self.digits)
            return self - error, self + error

    def __reduce__(self):
        return Exact, (str(self), self.digits)


class Certified(Result):
    """A certified run: t, x, y, vx, vy are `Exact`; `hits` holds those of each hit."""

    def _summary(self):
        return f"{self.status}, {self.collisions} collisions, {self.digits} digits"

    def __getattr__(self, key):
        value = super().__getattr__(key)
        return Exact(value, self._json["digits"]) if key in ("t", "x", "y", "vx", "vy") else value

    @property
    def hits(self):
        """A record for each hit: number, wall, t, x, y, vx, vy."""
        digits = self._json["digits"]
        names = ("t", "x", "y", "vx", "vy")
        return [
            Record({"number": n, "wall": wall} | dict(zip(names, (Exact(v, digits) for v in values))))
            for n, wall, *values in self._outcome.hits()
        ]

    def _main(self):
        return [dict(hit.__dict__) for hit in self.hits]

    def plot(self, ax=None, **keywords):
        raise NotImplementedError("a certified run has no picture; draw carom.run(…) in doubles")

    def __reduce__(self):
        raise TypeError("a certified run is not pickled; save() it")


class Section(Result):
    """Points of many orbits: `points`."""

    def __init__(self, outcome, system):
        super().__init__(outcome, system)
        self.points = outcome.points()

    def _summary(self):
        return f"{len(self.points)} points of {self.orbits} orbits"

    def _main(self):
        return self.points
