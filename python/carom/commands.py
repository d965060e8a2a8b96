"""The commands of the program as functions. Every key of a system file and every option of the
command is a keyword: `t_max=100`, `B=0.5`, `trajectories=10**6`, `integrator={"step": 0.01}`."""

import json
import os
from typing import Any, Callable, Optional, Union

import numpy

from . import _carom, records, results, stored, toml
from .errors import InputError, text_of
from .progress import Progress, progress_of, shown
from .return_times import Returns
from .sweep import Sweep, Swept
from .system import System, load, system


def _as_system(thing):
    if isinstance(thing, System):
        return thing
    if hasattr(thing, "tolist"):  # NumPy's strings
        thing = thing.tolist()
    try:
        text = os.fsdecode(thing)
    except TypeError:
        raise InputError(
            f"{thing!r} is not a system", ("", 0, 0, "system"),
            "a carom.System, the name of a built-in system, or a file",
        ) from None  # fmt: skip
    return load(text) if "/" in text or text.endswith(".toml") else system(text)


def _compute(kind, function, thing, command, keywords, progress, *arguments):
    of = _as_system(thing)
    if keywords.get("sweep") is not None:
        return _sweep(kind, function, of, command, keywords, progress, *arguments)
    keywords.pop("sweep", None)
    loaded = of._loaded(command, **keywords)
    outcome, error = shown(progress, function, loaded, *arguments, result_of=lambda part: kind(part, of))
    if error is None and hasattr(outcome, "check"):
        outcome.check()  # as the program, which ends with status 1
    result = kind(outcome, of._keeping(keywords))
    if error is not None:
        error.result = result
        raise error
    return result


def _sweep(kind, function, of, command, keywords, progress, *arguments):
    keywords = dict(keywords)
    swept = Swept(of, command, keywords, keywords.pop("sweep"))
    show = progress_of(progress)
    results_, error = [], None
    try:
        for i, (system_, loaded) in enumerate(swept.systems):
            part = None
            if show:
                part = lambda share, done, i=i: show((i + share) / len(swept.systems), done)  # noqa: E731
            outcome, error = function(loaded, *arguments, progress=part)
            results_.append(kind(outcome, system_))
            if error is not None:
                break
    finally:
        if hasattr(show, "close"):
            show.close()
    result = Sweep(swept.outcome(results_), swept.system, results_)
    if error is not None:
        error.result = result
        raise error
    return result


Systems = Union[System, str, "os.PathLike[str]"]


def escape(
    system: Systems,
    *,
    per_trajectory: bool = False,
    splitting=None,
    progress: Progress = None,
    **keywords: Any,
) -> Union[results.Escape, results.Splitting]:
    """Survival and escapes of an ensemble: a `carom.Escape`.

    system: a System, the name of a built-in one, or a system file. Keywords: keys of a system file
    (t_max: time, trajectories, seed, times, B, larmor_radius: length, speed: length/time, initial,
    …) and threads, isa, engine. progress: True, False, a function of (fraction, number done), or
    None: shown on a terminal and in notebooks. per_trajectory: keeps the start and the end of each
    trajectory. window=(from, to): times (time) between which the decay is fitted.

    sweep={"field.B": values}: a `carom.Sweep`, with a result for each value of a key; values are
    numbers or "lin:0:4:20", "log:1:1000:4"; two keys make a plane. All results have the same seed,
    unless the seed is swept. All commands that move particles, relax, orbits and compare have it.

    splitting="10,20,40" (times) or "hits:lin:0:30:31", with population, repetitions,
    kick and lookback: a `carom.Splitting`, for rare events.

    Ctrl-C raises KeyboardInterrupt, whose `result` holds what was computed so far.
    """
    keywords |= {"splitting": splitting, "per_trajectory": per_trajectory}
    if splitting is None:
        return _compute(results.Escape, _carom.ensemble, system, "escape", keywords, progress)
    if per_trajectory:
        raise InputError(
            "per_trajectory does not go with splitting",
            ("", 0, 0, "per_trajectory"), "a plain ensemble",
        )  # fmt: skip
    return _compute(results.Splitting, _carom.split, system, "escape", keywords, progress)


def diffusion(system: Systems, *, progress: Progress = None, **keywords: Any) -> results.Diffusion:
    """Mean square displacement and diffusion coefficient of an ensemble: a `carom.Diffusion`.

    Keywords: those of `carom.escape`, and window=(from, to), the report times (time) between which
    D and the exponent are fitted; free_paths=True counts the lengths of flights.
    """
    return _compute(results.Diffusion, _carom.ensemble, system, "diffusion", keywords, progress)


def lyapunov(
    system: Systems, *, per_trajectory: bool = False, progress: Progress = None, **keywords: Any
) -> results.Lyapunov:
    """Lyapunov exponents of an ensemble, and its chaotic fraction: a `carom.Lyapunov`.

    Keywords: those of `carom.escape`, and window=(from, to), the times (time) between which the
    growth of deviations is measured; spectrum=True computes all exponents of all particles together,
    and their entropy. per_trajectory: keeps start, end, exponent and SALI of each trajectory.
    """
    keywords["per_trajectory"] = per_trajectory
    return _compute(results.Lyapunov, _carom.ensemble, system, "lyapunov", keywords, progress)


def returns(system: Systems, *, on: str, progress: Progress = None, **keywords: Any) -> Returns:
    """Return times to a wall, in time and in hits: a `carom.Returns`.

    on: "wall:NAME". Keywords: those of `carom.escape`. Excursions count if they begin in the first
    half of t_max; each is then followed for at least half of t_max.
    """
    keywords["on"] = on
    return _compute(Returns, _carom.ensemble, system, "returns", keywords, progress)


def run(
    system: Systems,
    *,
    state_error: bool = True,
    on_hit: Optional[Callable[[numpy.ndarray], object]] = None,
    progress: Progress = None,
    **keywords: Any,
) -> Union[results.Run, results.Certified]:
    """One trajectory, followed closely: a `carom.Run`.

    position (length, 2 numbers), velocity (length/time): the start; default: `initial` of the
    system, drawn as number `trajectory` (0). collisions, t_max (time): the end. sample (time): time
    between stored states. state_error: estimates the error of the state under forces, which costs up
    to three times the run. on_hit: called a few times a second with the hits since the last call, an
    array like `carom.Run.hits`; `carom.hits` gives them without keeping them. precision="certified",
    digits=30: a `carom.Certified` with guaranteed digits.
    """
    if on_hit is not None and not callable(on_hit):
        raise InputError(f"'on_hit' is {on_hit!r}", ("", 0, 0, "on_hit"), "a function of an array of hits")
    precision = keywords.get("precision")
    if (precision is not None and text_of(precision, "precision") != "double") or keywords.get("digits") is not None:
        if on_hit is not None:
            raise InputError(
                "on_hit does not go with certified digits", ("", 0, 0, "on_hit"), "a run in doubles"
            )
        return _compute(
            results.Certified, _carom.run_certified, system, "run", keywords, progress
        )
    told = None if on_hit is None else lambda rows: on_hit(rows.view(records.Rows))
    return _compute(results.Run, _carom.run, system, "run", keywords, progress, state_error, told)


def compare(
    system: Systems,
    *,
    schemes=None,
    steps=None,
    tolerances=None,
    error=None,
    progress: Progress = None,
    **keywords: Any,
) -> results.Comparison:
    """Integrators compared on a system, error against work: a `carom.Comparison`.

    schemes: names, "all", or None: a dozen, arkode and cvode. steps (time), tolerances (relative):
    lists, or text such as "log:0.001:0.1:7"; None: chosen. error: the wanted relative error of the
    state (1e-6). t_max (time): end of the comparison; None: until small errors have grown 100 times.
    """
    keywords |= {"schemes": schemes, "steps": steps, "tolerances": tolerances, "error": error}
    return _compute(results.Comparison, _carom.compare, system, "compare", keywords, progress)


def schemes() -> numpy.ndarray:
    """The integrators, (number of schemes,): name, order and stages (NaN: they vary), kind,
    adaptive, symmetric, symplectic, quadratic (Runge–Kutta–Nyström), source."""
    return records.table_of(json.loads(_carom.schemes())["schemes"])


def section(system: Systems, *, progress: Progress = None, **keywords: Any) -> results.Section:
    """Points of orbits on walls, a line, a circle or a condition on the velocity: a `carom.Section`.

    on: "boundary", "wall:NAME", "line:x0,y0:x1,y1", "x=0" … (lengths); direction: "both",
    "positive" or "negative"; points: largest number for each orbit; orbits: number of orbits.
    """
    return _compute(results.Section, _carom.section, system, "section", keywords, progress)


def relax(
    system: Systems,
    *,
    starts: Union[int, str] = 200,
    saddles: bool = False,
    progress: Progress = None,
    **keywords: Any,
) -> results.Equilibria:
    """Equilibria of the potential energy and small oscillations about them: a `carom.Equilibria`.

    starts: number of starts that go downhill; saddles: searches for saddles too. Keywords: keys of
    a system file (particles, initial, seed, …) and threads.
    """
    keywords |= {"starts": starts, "saddles": saddles}
    return _compute(results.Equilibria, _carom.relax, system, "relax", keywords, progress)


def orbits(
    system: Systems,
    *,
    zeta: bool = False,
    certify: bool = False,
    progress: Progress = None,
    **keywords: Any,
) -> results.Orbits:
    """Periodic orbits of a free particle: a `carom.Orbits`.

    hits: largest number of hits of an orbit (6); starts: random orbits in which recurrences are
    sought (20000); tries: recurrences tried for each number of hits (2000). zeta: the escape rate of
    discs in the open plane from their orbits. certify: proves each orbit, with `digits` (20)
    decimals of its numbers as text. Ctrl-C raises KeyboardInterrupt, whose `result` holds the
    orbits found so far.
    """
    keywords |= {"zeta": zeta, "certify": certify}
    return _compute(results.Orbits, _carom.orbits, system, "orbit", keywords, progress)


def table(system: Systems, **keywords: Any) -> results.Table:
    """Checks and measures a table: a `carom.Table` with area (length²), perimeter (length), walls
    and holes. Keywords: keys of a system file."""
    of = _as_system(system)
    measured = _carom.measure(of._loaded("table", **keywords))
    return results.Table(measured, of.with_(**keywords))


def validate(
    *, soak: bool = False, scale=1, threads=None, progress: Progress = None
) -> results.Validation:
    """Checks the engine against identities and published values: a `carom.Validation`.

    scale multiplies the trajectories of every case; soak: the long runs. Ctrl-C raises
    KeyboardInterrupt, whose `result` holds the finished cases.
    """
    threads = "" if threads is None else toml.bare(threads, "threads")
    outcome, error = shown(progress, _carom.validate, soak, toml.bare(scale, "scale"), threads)
    result = results.Validation(outcome)
    if error is not None:
        error.result = result
        raise error
    return result


def open(path) -> stored.Result:  # noqa: A001: the name that users expect
    """The result that an archive holds, in the same classes as the functions that compute."""
    return stored.opened(path)
