"""A command for each of many values of a key, or each point of a plane of two keys."""

import itertools

import numpy

from . import _carom, plot, toml
from .errors import InputError, text_of
from .records import Rows
from .stored import Result, opened
from .system import _SECTION_OF, System


def typed(sweep):
    """{"field.B": values or "lin:0:4:20"} as what --sweep takes: of each key its path and its text."""
    expected = 'a dictionary such as {"field.B": [0, 0.5, 1]}'
    if not isinstance(sweep, dict) or not sweep:
        raise InputError(f"a sweep has keys and their values, not {sweep!r}", _PLACE, expected)
    texts = {}
    for key, values in sweep.items():
        if not isinstance(key, str):
            raise InputError(f"{key!r} is not a key of a system", _PLACE, expected)
        key = text_of(key, "sweep")
        values = values.tolist() if hasattr(values, "tolist") else values
        if isinstance(values, str):
            values = text_of(values, key)
        else:
            listed = list(values) if hasattr(values, "__iter__") else [values]
            if not listed or any(one is None or isinstance(one, (list, tuple, dict)) for one in listed):
                raise InputError(
                    f"sweep: '{key}' has no values in {values!r}", _PLACE,
                    'numbers, or text such as "lin:0:4:20"',
                )  # fmt: skip
            values = "list:" + ",".join(toml.bare(value, key) for value in listed)
        path = f"{_SECTION_OF[key]}.{key}" if key in _SECTION_OF else key
        texts[path] = f"{path}={values}"
    return texts


_PLACE = ("", 0, 0, "sweep")


class Swept:
    """What a sweep computes: the system of each value, all read before the first is flown."""

    def __init__(self, of, command, keywords, sweep):
        texts = typed(sweep)
        # The values of a sweep take the place of one that the system holds.
        changes = [one for one in of._changes if one[0] not in texts]
        options = [one for one in of._options if f"{_SECTION_OF.get(one[0])}.{one[0]}" not in texts]
        of = System(of._text, of._name, changes, options)
        text, name, _, changes, options = of._asked(command, **keywords)
        self.plan = _carom.plan_sweep(text, name, command, changes, options, list(texts.values()))
        self.system = of._keeping(keywords)
        names = [key for key, _ in self.plan.keys]
        self.systems = []
        for values in itertools.product(*(values for _, values in self.plan.keys)):
            swept = list(zip(names, values))
            kept = (*self.system._changes, *swept)
            self.systems.append(
                (
                    System(self.system._text, self.system._name, kept, self.system._options),
                    _carom.load(text, name, command, [*changes, *swept], options),
                )
            )

    def outcome(self, results):
        return _carom.make_sweep(self.plan, [result._outcome for result in results])


class Sweep(Result, archive="sweep"):
    """Results for the values of a key, or for the points of a plane.

    results: those of the command, in order; `sweep[i]` is the i-th. keys: records with key and
    values (as they are written). sweep: records with values and all keys of the result. Array:

    table  (number of values,): the keys, then the command's values and errors: rate,
           rate_stderr, D, D_stderr … in the units of the result; NaN: none. Where rows cannot be
           trusted or lack something, doubts and note say why; "": none
    """

    def __init__(self, outcome, system, results=None, table=None):
        super().__init__(outcome, system)
        self._results = results
        self._table = table

    @property
    def table(self) -> numpy.ndarray:
        """A row for each value, (values,): the keys, then each number of the result with its
        `_stderr`, in the units of the command's own results; NaN: none."""
        if self._table is None:
            columns = {name: numpy.asarray(column) for name, column in self._outcome.table().items()}
            self._table = numpy.empty(len(self), dtype=[(name, one.dtype) for name, one in columns.items()]).view(Rows)
            for name, one in columns.items():
                self._table[name] = one
        return self._table

    @property
    def results(self) -> list[Result]:
        """The result of each value; results of an archive are read on first use."""
        if self._results is None:
            self._results = [opened(value) for value in self._outcome.values]
            for result in self._results:
                result._folder = self._outcome  # of a copy it keeps the file from which rows are read
        return self._results

    def __getitem__(self, index):
        return self.results[index]

    def __len__(self):
        return len(self._json["sweep"])

    def _stored(self):
        archives = self._results is None or all(isinstance(one, Result) for one in self._results)
        return super()._stored() if archives else None

    def _made_of(self):
        return self._system, self._results, self.table

    def _pictures(self):
        return {"sweep": plot.sweep}

    def _summary(self):
        return f"{_carom.counted(len(self), 'value')} of {', '.join(key['key'] for key in self._json['keys'])}"

    def _main(self):
        return self.table
