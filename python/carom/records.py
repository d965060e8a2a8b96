"""JSON as Python objects: objects are records, lists of equal objects are NumPy arrays."""

import html
import json
import keyword
import os
import tempfile
from typing import Any

import numpy

from . import _carom, plot
from .errors import InputError, nearest, printable
from .estimates import Estimate


class Record:
    """A few named numbers: `paths.limit`, also `paths["limit"]`."""

    def __init__(self, entries):
        self.__dict__.update({key: python_of(value) for key, value in entries.items()})
        for key, value in entries.items():
            error = entries.get(f"{key}_stderr")
            if _is_number(value) and _is_number(error):
                self.__dict__[key] = Estimate(value, error)

    def __getattr__(self, key: str) -> Any:
        raise AttributeError(f"no '{key}' among {', '.join(self.__dict__)}{_hint(key, self.__dict__)}")

    def __getitem__(self, key: str) -> Any:
        return self.__dict__[key]

    def keys(self):
        """The names."""
        return self.__dict__.keys()

    def __repr__(self):
        return "(" + ", ".join(f"{key}={_short(value)}" for key, value in self.__dict__.items()) + ")"

    def __eq__(self, other):
        return isinstance(other, Record) and _exact(self) == _exact(other)


class Fit(Record):
    """A decay: its law, with what is certain about it."""

    def __init__(self, entries):
        super().__init__(entries)
        for key in ("rate", "exponent"):
            if _is_number(entries.get(key)) and _is_number(entries.get("stderr")):
                self.__dict__[key] = Estimate(entries[key], entries["stderr"])

    def __repr__(self):
        if self.model is None:
            return f"no law: {self.reason}"
        key = "rate" if "rate" in self.__dict__ else "exponent"
        kind = f"{self.model}, a local slope" if self.__dict__.get("local_slope") else self.model
        text = f"{kind}: {key} = {self[key]}"
        if "window" in self.__dict__:
            text += " from {:.6g} to {:.6g}".format(*self.window)
        said = [f"amplitude = {self.amplitude}"] if "amplitude" in self.__dict__ else []
        said += [f"plateau = {self.plateau}"] if self.__dict__.get("plateau") else []
        said += [f"p = {self.p_value:.2g}"] if _is_number(self.__dict__.get("p_value")) else []
        others = [one["model"] for one in self.__dict__.get("alternatives", ())]
        said += ["decided" if self.decided else "undecided" + (f", or {' or '.join(others)}" if others else "")]
        return f"{text}\n{', '.join(said)}"


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _short(value):
    """A value of a record on a few characters."""
    if isinstance(value, numpy.ndarray) and value.dtype.names:
        return f"<{_carom.counted(len(value), 'row')} of {', '.join(value.dtype.names)}>"
    if isinstance(value, list):
        texts = [_short(one) for one in value[:4]] + (["…"] if len(value) > 4 else [])
        return "[" + ", ".join(texts) + "]"
    if isinstance(value, Fit):
        return "(" + repr(value).replace("\n", ", ") + ")"
    return f"{value:.6g}" if type(value) is float else repr(value)


def _exact(value):
    """All digits, as something that can be compared."""
    if isinstance(value, (Record, Estimate)):
        return {key: _exact(one) for key, one in value.__dict__.items()}
    return repr(value.tolist() if isinstance(value, numpy.ndarray) else value)


def _hint(key, names):
    near = nearest(key, names)
    return f"; did you mean '{near}'?" if near else ""


class Rows(numpy.ndarray):
    """A structured array of NumPy whose columns are plain arrays; a row of a value and its error is an
    Estimate, and a wrong name has a hint."""

    def __getattr__(self, key):
        hint = f": a column is read as rows['{key}']" if key in (self.dtype.names or ()) else ""
        raise AttributeError(f"rows have no attribute '{key}'{hint}")

    def __getitem__(self, key):
        names = self.dtype.names
        if isinstance(key, str) and names and key not in names:
            raise InputError(
                f"no column '{key}' among {', '.join(names)}{_hint(key, names)}", ("", 0, 0, key), ", ".join(names),
                nearest(key, names),
            )  # fmt: skip
        part = super().__getitem__(key)
        if isinstance(part, numpy.void) and names == ("value", "stderr"):
            value, error = part.tolist()
            return Estimate(value, None if error != error else error)
        return part.view(numpy.ndarray) if isinstance(key, str) else part


def python_of(value):
    """A value of JSON with records and arrays in place of objects and lists of objects."""
    if isinstance(value, dict):
        if _is_number(value.get("value")) and "stderr" in value:
            more = {key: python_of(one) for key, one in value.items() if key not in ("value", "stderr")}
            return Estimate(value["value"], value["stderr"], **more)
        is_fit = "model" in value and ("decided" in value or value["model"] is None)
        return Fit(value) if is_fit else Record(value)
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
    return numpy.array(list(zip(*(column for _, column in columns.values()))), dtype).view(Rows)


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
            names = [name for name in dir(self) if not name.startswith("_") and not keyword.iskeyword(name)]
            raise AttributeError(f"{type(self).__name__} has no '{key}'{_hint(key, names)}")
        if entries[key] == [] and key in self._COLUMNS:
            return numpy.empty(0, self._COLUMNS[key]).view(Rows)
        return python_of(entries[key])

    def __dir__(self):
        return [*super().__dir__(), *self.__dict__.get("_json", ())]

    def plot(self, ax=None, **keywords):
        """Draws what there is to see with a function of `carom.plot`; returns its axes, or an array of them
        where the picture has several. `what` chooses among pictures; `ax`, color, label, linewidth and alpha are
        matplotlib's."""
        return plot.result(self, ax=ax, **keywords)

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
