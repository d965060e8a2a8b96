"""Systems: a table with its field, particles, forces and run, as a system file describes them."""

import functools
import inspect
import json
from typing import Any, Callable, TypeVar, cast

from . import _carom, page, plot, toml
from .errors import InputError, nearest, path_of, printable, text_of

_KEYS = _carom.keys()
#: Sections of a system file, and the key above them.
_SECTIONS = {section.split(".")[0] for section, *_ in _KEYS if section} | {"initial", "table", "title"}
_SECTION_OF: dict[str, str] = {}
for _section, _kind, _key, *_rest in _KEYS:
    if _section in ("field", "particles", "integrator", "run", "section"):
        _SECTION_OF.setdefault(_key, _section)

# Options of the program that are about its files and its prints.
_NO_KEYWORDS = (
    "json", "quiet", "verbose", "output", "force", "set", "closed", "resume", "checkpoint", "shard", "block",
)  # fmt: skip
#: Of each command the options that are keywords, and whether a value follows them.
_OPTIONS = {
    command: {name: valued for name, valued in options if name not in _NO_KEYWORDS}
    for command, options in _carom.options()
}
_ALL_OPTIONS = {name: valued for options in _OPTIONS.values() for name, valued in options.items()}
#: Names of the options that a system holds for its commands, beside the keys of its file.
_HELD = ("position", "velocity", "engine", "isa", "threads", "trajectory")
_ARCHIVES = (".h5", ".hdf5")


#: Keywords that a system holds; the others say how one command computes.
OF_A_SYSTEM = frozenset((*_SECTION_OF, *_SECTIONS, *_HELD, "angle"))


def function_of(command):
    """The name of a command's function."""
    return "carom." + ("orbits" if command == "orbit" else command)


def _check(key, command):
    """Throws InputError for a keyword that means nothing to a command; without a command: to a system."""
    text_of(key, "keyword")
    if command is None:
        known = set(OF_A_SYSTEM)
        what = "a system"
    else:
        keys = {key for key in (*_SECTION_OF, *_SECTIONS, "angle") if key not in _ALL_OPTIONS}
        known = keys | set(_OPTIONS[command])
        what = function_of(command)
    if key in known:
        return
    others = [function_of(other) for other, options in _OPTIONS.items() if key in options]
    near = _carom.nearest_name(key, sorted(known))
    hint = f"; did you mean '{near}'?" if near else ""
    problem = (
        f"'{key}' means nothing to {what}: it is a keyword of {', '.join(others)}"
        if others
        else f"{what} has no keyword '{key}'"
    )
    expected = "a key of a system file" + (f" or an option of {what}" if command else "")
    raise InputError(problem + hint, ("", 0, 0, key), expected, near)


def _typed(key, given):
    """A value as it is typed after an option: 1/3, 10,20,40."""
    given = given.tolist() if hasattr(given, "tolist") else given
    if isinstance(given, str):
        text = text_of(given, key)
    elif hasattr(given, "__iter__"):
        text = (":" if key == "window" else ",").join(toml.bare(one, key) for one in given)
    else:
        text = toml.bare(given, key)
    if not text.strip():
        raise InputError(f"'{key}' needs a value", ("", 0, 0, key), "a value, or None")
    return text


def _changes(keywords, command=None):
    """Keywords as what --set and the options of the program say: two lists of (name, text)."""
    changes, options = [], []
    beside = [key for key in ("position", "velocity") if keywords.get(key) is not None]
    if keywords.get("initial") is not None and beside:
        raise InputError(
            f"'initial' and '{beside[0]}' are both given", ("", 0, 0, beside[0]), "one of the two"
        )
    for key, given in keywords.items():
        _check(key, command)
        if given is None:
            continue
        section = _SECTION_OF.get(key)
        if _ALL_OPTIONS.get(key) and not (section and isinstance(given, dict)):
            options.append((key, _typed(key, given)))
        elif key == "angle":
            changes.append(("initial.angle", toml.value(given, key)))
        elif section:
            changes.append((f"{section}.{key}", toml.value(given, key)))
        elif key in _SECTIONS:
            if key == "initial" and isinstance(given, str):
                given = {"kind": given}
            if key in ("potential", "injection") and isinstance(given, dict):
                given = [given]
            changes.append((key, toml.value(given, key)))
        elif not isinstance(given, bool):
            raise InputError(f"'{key}' is {given!r}", ("", 0, 0, key), "True or False")
        elif given:
            options.append((key, "true"))
    return changes, options


Made = TypeVar("Made", bound=Callable[..., Any])


def of_keywords(function: Made) -> Made:
    """What makes a system of keywords: wrong ones have a hint, and errors speak of keywords."""
    parameters = inspect.signature(function).parameters
    names = [name for name in parameters if name != "self"]
    others = any(one.kind is one.VAR_KEYWORD for one in parameters.values())

    @functools.wraps(function)
    def make(*arguments, **keywords):
        for key in () if others else keywords:
            if key not in names:
                near = nearest(key, names)
                hint = f"; did you mean '{near}'?" if near else ""
                problem = f"carom.{function.__name__} has no keyword '{key}'{hint}"
                raise InputError(problem, ("", 0, 0, key), ", ".join(names), near)
        try:
            return function(*arguments, **keywords)
        except InputError as error:
            whole = error.place.key
            key = whole.rpartition(".")[2]
            if key == whole or key.partition("[")[0] not in {*names, *keywords}:
                raise
            raise InputError(
                str(error).replace(whole, key, 1), ("", 0, 0, key), error.expected, error.nearest
            ) from None

    return cast(Made, make)


class System:
    """A system: the contents of a system file, with changes. Its methods return new systems.

    Made by `carom.load`, `carom.system`, `carom.stadium` and the other shapes.
    """

    def __init__(self, text, name, changes=(), options=()):
        self._text = text
        self._name = name
        self._changes = tuple(changes)
        self._options = tuple(options)
        self._tables = {}

    # What it is made of.

    def with_(self, **keywords) -> "System":
        """The same system with other values: `system.with_(B=0.5, t_max=100)`."""
        changes, options = _changes(keywords)
        held_changes, held = self._held_beside(keywords)
        return System(self._text, self._name, (*held_changes, *changes), (*held, *options))

    def _keeping(self, keywords):
        """The same system with those keywords of a command that a system holds."""
        return self.with_(**{key: value for key, value in keywords.items() if key in OF_A_SYSTEM})

    def _held_beside(self, keywords):
        """What stays of what the system holds: a start as a whole takes the place of that before."""
        given = {key for key in ("position", "velocity", "angle", "initial") if keywords.get(key) is not None}
        if "initial" not in given and not ("position" in given and len(given) > 1):
            return self._changes, self._options
        return (
            [one for one in self._changes if one[0].split(".")[0] != "initial"],
            [one for one in self._options if one[0] not in ("position", "velocity")],
        )

    def _append(self, text):
        if self._text and not any(key.split(".")[0] == "table" for key, _ in self._changes):
            return System(self._text + text, self._name, self._changes, self._options)._checked()
        # Changes are made after the text is read: what they have made of the table is written first.
        written = self.to_toml().replace("\nhole = []\n", "\n")
        return System(written + text, self._name, (), self._options)._checked()

    def _checked(self):
        self._loaded("table")
        return self

    @of_keywords
    def hole(self, wall, center=None, width=None, name=None, **keys) -> "System":
        """An opening of that width in a wall, its middle at the arc length `center` (lengths)."""
        return self._append(
            toml.section(
                "table.hole", {"wall": wall, "center": center, "width": width, "name": name, **keys}, True
            )
        )

    @of_keywords
    def obstacle(self, shape, name=None, **keys) -> "System":
        """A hard obstacle: "circle" {center, radius}, "ellipse" {center, a, b, angle}, "polygon" {points},
        "spline" {points}, "path" {start, pieces}, "polar" {radius, a formula of `phi`; center} or
        "parametric" {x, y, formulas of `t`; start, end}; lengths and radians."""
        if shape == "parametric":
            keys = {{"start": "from", "end": "to"}.get(key, key): one for key, one in keys.items()}
        return self._append(
            toml.section("table.obstacle", {"shape": shape, "name": name, **keys}, True)
        )

    @of_keywords
    def wall(self, law, wall=None, **keys) -> "System":
        """How a wall reflects, or all of them: law "specular", "diffuse", "mixed" {specularity}, "rough"
        {angle} or "thermal" {temperature, an energy}."""
        return self._append(toml.section("table.wall", {"wall": wall, "law": law, **keys}, True))

    @of_keywords
    def region(self, wall=None, **keys) -> "System":
        """Particles enter the obstacle of that wall; or without one what is on the left of an edge, {start,
        pieces}, from one corner of the table to another. index, potential (energy), B: within; reflection:
        "none", "s", "p", or a formula in incidence, refraction and n."""
        return self._append(toml.section("table.region", {"wall": wall, **keys}, True))

    def closed(self) -> "System":
        """The same without holes."""
        return System(
            self._text, self._name, (*self._changes, ("table.hole", "[]")), self._options
        )

    def to_toml(self) -> str:
        """The complete system file, which the program takes too."""
        return self._loaded("table").toml

    def _asked(self, command, **keywords):
        """What a command is asked for, as the compiled module takes it. Keywords must be the command's
        own; what the system holds is used where it means something."""
        changes, options = _changes(keywords, command)
        all_changes, all_options = self._held_beside(keywords)
        held_changes, held = list(all_changes), []
        for key, text in all_options:
            if key in _OPTIONS[command] or _SECTION_OF.get(key) == "run" or key in ("position", "velocity"):
                held.append((key, text))
            elif key in _SECTION_OF:
                held_changes.append((f"section.{key}", text))
        return self._text, self._name, command, [*held_changes, *changes], [*held, *options]

    def _loaded(self, command, **keywords):
        return _carom.load(*self._asked(command, **keywords))

    def __reduce__(self):
        return System, (self._text, self._name, self._changes, self._options)

    # What it looks like.

    def _table(self):
        if not self._tables:
            self._tables.update(json.loads(_carom.measure(self._loaded("table")).json()))
        return self._tables

    @property
    def name(self) -> str:
        """The name of the built-in system, or the file."""
        return self._name

    @property
    def title(self) -> str:
        """A line for pictures and reports."""
        return self._loaded("table").title

    @property
    def area(self) -> float:
        """Of the table, or of one cell of its lattice (length²); infinite in the open plane."""
        return float(self._table()["area"])

    @property
    def perimeter(self) -> float:
        """The length of all walls (length)."""
        return float(self._table()["perimeter"])

    @property
    def mean_flight(self) -> float:
        """π·area/perimeter: the mean way from hit to hit without a field (length)."""
        return float(self._table()["mean_flight"])

    @property
    def walls(self) -> list[str]:
        """Names of the walls, in the order of their numbers."""
        return [wall["name"] for wall in self._table()["walls"]]

    @property
    def holes(self) -> list[str]:
        """Names of the holes, in the order of their numbers."""
        return [hole["name"] for hole in self._table()["holes"]]

    def __repr__(self):
        table = self._table()
        holes = f", holes {', '.join(self.holes)}" if table["holes"] else ""
        more = ", …" if len(self.walls) > 8 else ""
        walls = ", ".join(self.walls[:8]) + more
        return printable(f"<carom.System {self._name}: {table['shape']}, walls {walls}{holes}>")

    def _repr_svg_(self):
        from io import StringIO

        picture = StringIO()
        self.plot().figure.savefig(picture, format="svg")
        return picture.getvalue()

    def _pictures(self):
        return {"table": plot.table}

    def show(self, width="100%", height=820):
        """The page that computes in a browser, with this system: in a notebook a frame (pixels), else in
        a browser. It shows the same numbers as the module, to the last bit."""
        return page.show(self, width, height)

    def plot(self, ax=None, **keywords):
        """Draws the table, its holes and level lines of its potentials."""
        return plot.table(self, ax=ax, **keywords)


def load(path) -> System:
    """A system file (TOML)."""
    path = path_of(path)
    if path.endswith(_ARCHIVES):
        raise InputError(f"{path}: an archive is not a system; carom.open reads it", (path, 0, 0, ""), "a TOML file")
    written = _carom.read_text(path)
    text: str | bytes = written
    name = path if "/" in path or "." in path else f"./{path}"  # other names are those of systems
    try:
        text = written.decode()
    except UnicodeDecodeError:  # where it is no text is told by what reads it
        pass
    return System(text, name)._checked()


def system(name: str) -> System:
    """A built-in system, by its name: see `carom.systems()`."""
    texts = dict(_carom.systems())
    name = text_of(name, "name")
    if name not in texts:
        near = _carom.nearest_name(name, list(texts))
        hint = f", did you mean '{near}'?" if near else ""
        if name.endswith((".toml", *_ARCHIVES)):
            hint = f"; carom.{'load' if name.endswith('.toml') else 'open'} reads a file"
        raise InputError(f"there is no system '{name}'{hint}", ("", 0, 0, name), ", ".join(texts), near)
    return System(texts[name], name)


def systems() -> list[str]:
    """Names of the built-in systems."""
    return [name for name, _ in _carom.systems()]
