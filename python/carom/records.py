"""JSON as Python objects: objects are records, lists of equal objects are NumPy arrays."""

import html
import json
import os
import tempfile
from typing import Any

import numpy

from . import _carom
from .errors import printable


class Record:
    """A few named numbers: `D.value`, also `D["value"]`."""

    def __init__(self, entries):
        self.__dict__.update({key: python_of(value) for key, value in entries.items()})

    def __getattr__(self, key: str) -> Any:
        raise AttributeError(f"no '{key}' among {', '.join(self.__dict__)}")

    def __getitem__(self, key: str) -> Any:
        return self.__dict__[key]

    def keys(self):
        """The names."""
        return self.__dict__.keys()

    def __repr__(self):
        return "(" + ", ".join(f"{key}={value!r}" for key, value in self.__dict__.items()) + ")"

    def __eq__(self, other):
        return isinstance(other, Record) and repr(self) == repr(other)


def python_of(value):
    """A value of JSON with records and arrays in place of objects and lists of objects."""
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
        return array_of(value)
    return value


# What no key's values tell: counts, and texts that all rows may lack. Other numbers are float64, also
# where all of them happen to be whole.
_COUNTS = frozenset(
    "n number count chaotic escaped collisions hits copies steps force_evaluations unresolved_steps"
    " only_double only_certified descending neutral found first seed unresolved lost singular".split()
)
_TEXTS = frozenset(("failure", "reason", "areas_reason"))


def array_of(rows):
    """A list of objects with equal keys as a structured array, if they hold numbers, names and
    points; else as records."""
    if any(row.keys() != rows[0].keys() for row in rows):
        return [Record(row) for row in rows]
    array = table_of(rows)
    return array if len(array.dtype.names) == len(rows[0]) else [Record(row) for row in rows]


def table_of(rows, unknown=()):
    """A list of objects as a structured array of numbers and names: what is missing, or null, is
    not a number. Objects among the entries are left out. `unknown`: flags that may be null, as 1, 0
    or not a number."""
    columns = columns_of(rows)
    columns.update((key, (("f8",), columns[key][1])) for key in unknown)
    dtype = [(key, *kind) for key, (kind, _) in columns.items()]
    return numpy.array(list(zip(*(column for _, column in columns.values()))), dtype)


def columns_of(rows):
    """Of each key that has one its kind, by NumPy, and its column."""
    columns = {}
    for key in dict.fromkeys(key for row in rows for key in row):
        column = [row.get(key) for row in rows]
        kind = _kind_of(key, [one for one in column if one is not None])
        if kind is None:
            continue
        nothing = "" if kind[0].startswith("U") else float("nan")
        if len(kind) > 1:
            nothing = (nothing, nothing)
        column = [nothing if one is None else tuple(one) if isinstance(one, list) else one for one in column]
        columns[key] = (kind, column)
    return columns


def _kind_of(key, known):
    """What an array of these is made of; None: of too different things."""
    if key in _TEXTS or (known and all(isinstance(one, str) for one in known)):
        return (f"U{max(map(len, known), default=0) or 1}",)
    if known and all(isinstance(one, bool) for one in known):
        return ("?",)
    if any(isinstance(one, bool) for one in known):
        return None
    if known and key in _COUNTS and all(isinstance(one, int) for one in known):
        return ("i8",)
    if all(isinstance(one, (int, float)) for one in known):
        return ("f8",)
    if all(isinstance(one, list) and len(one) == 2 for one in known):
        if all(isinstance(part, (int, float)) for one in known for part in one):
            return ("f8", (2,))
    return None


def outcome_of(path):
    """The kind of an archive, and what the compiled module reads of it."""
    kind = _carom.kind_of_archive(path)
    return kind, (_carom.open_sweep if kind == "sweep" else _carom.open_outcome)(path)


class Kept:
    """What a pickled report is made of: what it says, as text, and the archive that has its rows."""

    def __init__(self, said, archive):
        self._said = said
        self._archive = archive
        self._outcome = None

    def json(self):
        return self._said[0]

    def text(self):
        return self._said[1]

    def doubts(self):
        return list(self._said[2])

    def __getattr__(self, name):
        if self._archive is None:
            raise AttributeError(name)
        if self._outcome is None:
            self._folder = tempfile.TemporaryDirectory()  # a sweep's results are read from it later
            file = os.path.join(self._folder.name, "result.h5")
            with open(file, "wb") as stream:
                stream.write(self._archive)
            self._outcome = outcome_of(file)[1]
        return getattr(self._outcome, name)


def _unpickled(kind, said, archive, *rest):
    """A report from what `Report.__reduce__` tells."""
    report = kind(Kept(said, archive), *rest)
    if archive is not None:
        report._archive = archive
    return report


class Report:
    """What a command reports: `print(report)` shows its text, attributes are the keys of its JSON. It can
    be pickled and copied: what it says is kept word for word, rows are kept as its archive."""

    #: Columns of arrays that may have no row, which would tell them.
    _COLUMNS: dict[str, list[tuple]] = {}

    def __init__(self, outcome):
        self._outcome = outcome
        self._json = json.loads(outcome.json())

    def __reduce__(self):
        outcome = self._outcome
        said = (outcome.json(), outcome.text(), outcome.doubts())
        return _unpickled, (type(self), said, self._stored(), *self._made_of())

    def _stored(self):
        """The bytes of its archive, if it has one."""
        return None

    def _made_of(self):
        """What its class is called with, beside the outcome."""
        return ()

    @property
    def json(self) -> dict[str, Any]:
        """All keys and values, as the program's --json prints them."""
        return json.loads(self._outcome.json())

    @property
    def doubts(self) -> list[str]:
        """Why the result cannot be trusted, a line each: [] where it can."""
        return self._outcome.doubts()

    def __getattr__(self, key: str) -> Any:
        entries = self.__dict__.get("_json")
        if entries is None or key not in entries:
            names = list(entries or ())
            nearest = _carom.nearest_name(key, names)
            hint = f"; did you mean '{nearest}'?" if nearest else ""
            raise AttributeError(f"{type(self).__name__} has no '{key}'{hint}")
        if entries[key] == [] and key in self._COLUMNS:
            return numpy.empty(0, self._COLUMNS[key])
        return python_of(entries[key])

    def __dir__(self):
        return [*super().__dir__(), *self._json]

    def to_dataframe(self):
        """The main table as a pandas.DataFrame (Debian: python3-pandas)."""
        import pandas

        main = self._main()
        frame = pandas.DataFrame(main)
        if isinstance(main, list):
            for key, (kind, column) in columns_of(main).items():
                if len(kind) == 1:
                    frame[key] = numpy.array(column, dtype=object if kind[0].startswith("U") else kind[0])
        return frame

    def _main(self):
        raise NotImplementedError

    def _pictures(self):
        """Functions of `carom.plot` that draw it, by name."""
        return {}

    def _summary(self):
        raise NotImplementedError

    def _of(self):
        return ""

    def __str__(self):
        return printable(self._outcome.text(), lines=True)

    def __repr__(self):
        return printable(f"<carom.{type(self).__name__}{self._of()}: {self._summary()}>")

    def _repr_html_(self):
        return f"<pre>{html.escape(str(self))}</pre>"
