"""JSON as Python objects: objects are records, lists of equal objects are NumPy arrays."""

import html
import json
from typing import Any

import numpy

from . import _carom


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


def array_of(rows):
    """A list of objects with equal keys as a structured array, if they hold numbers, names and
    points; else as records."""
    first = rows[0]
    kinds = []
    for key in first:
        kind = _kind_of([row.get(key) for row in rows])
        if kind is None:
            return [Record(row) for row in rows]
        kinds.append((key, *kind))
    if any(row.keys() != first.keys() for row in rows):
        return [Record(row) for row in rows]
    plain = [tuple(tuple(v) if isinstance(v, list) else v for v in row.values()) for row in rows]
    return numpy.array(plain, dtype=kinds)


def table_of(rows):
    """A list of objects as a structured array of numbers and names: what is missing, or null, is
    not a number. Objects among the entries are left out."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    columns = {key: [row.get(key) for row in rows] for key in keys}
    kinds = {}
    for key, column in columns.items():
        known = [one for one in column if one is not None]
        kind = _kind_of(known) if known else ("f8",)
        if kind is None or any(isinstance(one, dict) for one in known):
            continue
        if len(known) < len(column):
            kind = kind if kind[0].startswith("U") else ("f8", *kind[1:])
            nothing = "" if kind[0].startswith("U") else float("nan")
            nothing = [nothing] * kind[1][0] if len(kind) > 1 else nothing
            columns[key] = [nothing if one is None else one for one in column]
        kinds[key] = kind
    dtype = [(key, *kind) for key, kind in kinds.items()]
    return numpy.array([tuple(columns[key][i] for key in kinds) for i in range(len(rows))], dtype)


def _kind_of(column):
    """What an array of these is made of; None: of too different things."""
    if all(isinstance(one, bool) for one in column):
        return ("?",)
    if any(isinstance(one, bool) for one in column):
        return None
    if all(isinstance(one, int) for one in column):
        return ("i8",)
    if all(isinstance(one, (int, float)) for one in column):
        return ("f8",)
    if all(isinstance(one, str) for one in column):
        return (f"U{max(map(len, column)) or 1}",)
    if all(isinstance(one, list) and len(one) == 2 for one in column):
        if all(isinstance(part, (int, float)) for one in column for part in one):
            return ("f8", (2,))
    return None


class Report:
    """What a command reports: `print(report)` shows its text, attributes are the keys of its JSON."""

    def __init__(self, outcome):
        self._outcome = outcome
        self._json = json.loads(outcome.json())

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
        return python_of(entries[key])

    def __dir__(self):
        return [*super().__dir__(), *self._json]

    def to_dataframe(self):
        """The main table as a pandas.DataFrame (Debian: python3-pandas)."""
        import pandas

        return pandas.DataFrame(self._main())

    def _main(self):
        raise NotImplementedError

    def _summary(self):
        raise NotImplementedError

    def _of(self):
        return ""

    def __str__(self):
        return self._outcome.text() if hasattr(self._outcome, "text") else repr(self)

    def __repr__(self):
        return f"<carom.{type(self).__name__}{self._of()}: {self._summary()}>"

    def _repr_html_(self):
        return f"<pre>{html.escape(str(self))}</pre>"
