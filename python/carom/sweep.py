"""A command for each of many values of a key, or each point of a plane of two keys."""

import itertools
import os
import tempfile

import numpy

from . import _carom, plot, toml
from .errors import InputError, text_of
from .stored import Result, check_archive, opened
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
        reports = [(r._outcome.json(), "\n".join((*r.doubts, "")) if r.doubts else "") for r in results]
        return _carom.make_sweep(self.plan, reports)


class Sweep(Result, archive="sweep"):
    """Results for the values of a key, or for the points of a plane.

    results: those of the command, in order; `sweep[i]` is the i-th. keys: records with key and
    values (as they are written). sweep: records with values and all keys of the result. Array:

    table  (number of values,): the keys, then what the command has of value and error: rate,
           rate_stderr, D, D_stderr … in the units of the result; NaN where there is none
    """

    def __init__(self, outcome, system, results=None):
        super().__init__(outcome, system)
        self._results = results

    @property
    def table(self) -> numpy.ndarray:
        """A row for each value, (values,): the keys, then each number of the result with its
        `_stderr`, in the units of the command's own results; NaN: there is none."""
        columns = self._outcome.table()
        arrays = [numpy.asarray(column) for column in columns.values()]
        rows = numpy.empty(
            len(arrays[0]), dtype=[(name, one.dtype) for name, one in zip(columns, arrays)]
        )
        for name, one in zip(columns, arrays):
            rows[name] = one
        return rows

    @property
    def results(self) -> list[Result]:
        """The result of each value; of an archive they are read when they are asked for."""
        if self._results is None:
            made = []
            folder = tempfile.TemporaryDirectory()
            for index in self._outcome.indices:
                file = os.path.join(folder.name, f"{index}.h5")
                if not self._outcome.extract(index, file):
                    raise ValueError(f"the sweep stores no archive of its value {index}")
                result = opened(file)
                with open(file, "rb") as stream:
                    result._archive = stream.read()
                result._folder = folder  # its rows are read when they are asked for
                made.append(result)
            self._results = made
        return self._results

    def __getitem__(self, index):
        return self.results[index]

    def __len__(self):
        return len(self._outcome.indices)

    def save(self, path, force: bool = False) -> None:
        """Writes the archive that the program writes with -o; `force` replaces one."""
        if self._archive is not None:
            super().save(path, force)
            return
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for index, result in enumerate(self.results):
                files.append(os.path.join(folder, f"{index}.h5") if hasattr(result, "save") else "")
                if files[-1]:
                    result.save(files[-1])
            self._outcome.save(check_archive(path), force, files)

    def _made_of(self):
        return self._system, self._results

    def _pictures(self):
        return {"sweep": plot.sweep}

    def plot(self, ax=None, y=None):
        """A column of the table against the key, with error bars; of a plane a map."""
        return plot.sweep(self, ax=ax, y=y)

    def _summary(self):
        return f"{_carom.counted(len(self), 'value')} of {', '.join(key['key'] for key in self._json['keys'])}"

    def _main(self):
        return self.table
