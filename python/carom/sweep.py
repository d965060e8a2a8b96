"""A command for each of many values of a key, or each point of a plane of two keys."""

import itertools
import os
import tempfile

import numpy

from . import _carom, toml
from .errors import InputError
from .results import Result
from .system import _SECTION_OF, System


def typed(sweep):
    """{"field.B": values or "lin:0:4:20"} as what --sweep takes."""
    texts = []
    for key, values in sweep.items():
        if "." not in key and key in _SECTION_OF:
            key = f"{_SECTION_OF[key]}.{key}"
        if not isinstance(values, str):
            values = "list:" + ",".join(toml.bare(value) for value in numpy.atleast_1d(values).tolist())
        texts.append(f"{key}={values}")
    return texts


class Swept:
    """What a sweep computes: the system of each value, all read before the first is flown."""

    def __init__(self, of, command, keywords, sweep):
        self.keys = _carom.swept_keys(command, typed(sweep))
        self.command, self.of, self.keywords = command, of, keywords
        names = [key for key, _ in self.keys]
        self.systems = []
        for values in itertools.product(*(values for _, values in self.keys)):
            set_ = list(zip(names, values))
            made = System(of._text, of._name, (*of._changes, *set_), of._options)
            self.systems.append((made, made._loaded(command, **keywords)))

    def base(self):
        """The system without the sweep, or its first one where the keys are needed."""
        try:
            return self.of._loaded(self.command, **self.keywords)
        except InputError:
            return self.systems[0][1]

    def outcome(self, results):
        base = self.base()
        reports = [(r._outcome.json(), "\n".join((*r.doubts, "")) if r.doubts else "") for r in results]
        return _carom.make_sweep(
            self.command, self.keys, base.toml, base.name,
            [loaded.toml for _, loaded in self.systems], reports,
        )  # fmt: skip


class Sweep(Result):
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
            from .commands import open as open_archive

            made = []
            with tempfile.TemporaryDirectory() as folder:
                for index in self._outcome.indices:
                    file = os.path.join(folder, f"{index}.h5")
                    if not self._outcome.extract(index, file):
                        raise ValueError(f"the sweep stores no archive of its value {index}")
                    result = open_archive(file)
                    with open(file, "rb") as stream:
                        result._archive = stream.read()
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
            self._outcome.save(str(path), force, files)

    def plot(self, ax=None, y=None):
        """A column of the table against the key, with error bars; of a plane a map."""
        from . import plot

        return plot.sweep(self, ax=ax, y=y)

    def _summary(self):
        return f"{_carom.counted(len(self), 'value')} of {', '.join(key['key'] for key in self._json['keys'])}"

    def _main(self):
        return self.table
