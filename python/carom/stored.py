"""What all results have: they belong to a system, are saved, opened and drawn."""

import os
import tempfile

from . import _carom
from .errors import InputError, path_of
from .records import Report, outcome_of
from .system import System


class OfSystem(Report):
    """What a command reports of a system."""

    def __init__(self, outcome, system):
        super().__init__(outcome)
        self._system = system

    @property
    def system(self) -> System:
        """The system that was computed."""
        return self._system

    def _of(self):
        return f" of {self._system.name}"

    def _made_of(self):
        return (self._system,)


def check_archive(path):
    """The name of an archive, as text. Other endings are refused, as by the program."""
    path = path_of(path)
    if os.path.splitext(path)[1] not in ("", ".h5", ".hdf5", ".part"):
        raise InputError(
            f"'{path}' does not end as an archive", (path, 0, 0, ""), ".h5 or .hdf5; plot() draws pictures"
        )
    return path


class Result(OfSystem):
    """A result that an archive can hold: it is saved and opened."""

    _KINDS: dict[str, type["Result"]] = {}  # of archives

    def __init_subclass__(cls, archive: str = "", **keywords):
        super().__init_subclass__(**keywords)
        Result._KINDS.setdefault(archive, cls)

    def __init__(self, outcome, system):
        super().__init__(outcome, system)
        self._archive = None  # that it was read from: its name, or its bytes
        self._folder = None  # that holds the archive as long as rows are read from it

    def save(self, path, force: bool = False) -> None:
        """Writes the archive that the program writes with -o; `force` replaces one."""
        path = check_archive(path)
        if self._archive is None:
            self._outcome.save(path, force)
            return
        if os.path.exists(path) and not force:
            raise InputError(f"{path}: the output file exists already", (path, 0, 0, ""))
        archive = self._archive
        if isinstance(archive, str) and not os.path.exists(archive):  # a value of a sweep
            _carom.extract_value(archive, path)
            return
        if isinstance(archive, str):
            with open(archive, "rb") as stream:
                archive = stream.read()
        try:
            with open(path, "wb") as stream:
                stream.write(archive)
        except OSError as error:
            raise InputError(f"cannot write '{path}': {error.strerror}", (path, 0, 0, "")) from None

    def _stored(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "result.h5")
            self.save(file)
            with open(file, "rb") as stream:
                return stream.read()


def opened(path) -> Result:
    """The result that an archive holds."""
    path = path_of(path)
    try:
        kind, outcome = outcome_of(path)
        of = outcome.system
        trajectory = getattr(outcome, "trajectory", None)
        options = [] if trajectory is None else [("trajectory", str(trajectory))]
        result = Result._KINDS[kind](outcome, System(of.toml, of.name, (), options))
    except InputError:
        raise
    except (ArithmeticError, AttributeError, LookupError, MemoryError, RuntimeError, TypeError, ValueError) as error:
        raise InputError(
            f"{path}: the archive is damaged ({type(error).__name__}: {error})", (path, 0, 0, ""),
            "an archive as carom wrote it",
        ) from error  # fmt: skip
    result._archive = path
    return result
