"""The commands of the program as functions. Every key of a system file and every option of the
command is a keyword: `t_max=100`, `B=0.5`, `trajectories=10**6`, `integrator={"step": 0.01}`."""

import os
import sys
import time

from . import _carom, results
from .errors import InputError
from .system import System, load, system


def _as_system(thing):
    if isinstance(thing, System):
        return thing
    text = os.fspath(thing)
    return load(text) if "/" in text or text.endswith(".toml") else system(text)


class _Line:
    """How far it is, on one line of a terminal."""

    def __init__(self):
        self.last = time.monotonic()
        self.shown = False

    def __call__(self, share, done):
        if time.monotonic() - self.last < 0.5:
            return
        self.last = time.monotonic()
        self.shown = True
        sys.stderr.write(f"\r{100 * share:5.1f} %  {done} done ")
        sys.stderr.flush()

    def close(self):
        if self.shown:
            sys.stderr.write("\r\033[K")


class _Bar:
    """The same by tqdm."""

    def __init__(self, tqdm):
        self.bar = tqdm(total=1.0, bar_format="{percentage:3.0f} %|{bar}| {elapsed}<{remaining}")

    def __call__(self, share, done):
        self.bar.update(share - self.bar.n)

    def close(self):
        self.bar.close()


def _progress(progress):
    if callable(progress):
        return progress
    if progress is None:
        progress = sys.stderr.isatty()
    if not progress:
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _Line()
    return _Bar(tqdm)


def _compute(kind, function, thing, command, keywords, progress, *arguments):
    of = _as_system(thing)
    loaded = of._loaded(command, **keywords)
    shown = _progress(progress)
    try:
        outcome, error = function(loaded, *arguments, progress=shown)
    finally:
        if hasattr(shown, "close"):
            shown.close()
    result = kind(outcome, of.with_(**keywords))
    if error is not None:
        error.result = result
        raise error
    return result


def escape(system, *, per_trajectory=False, progress=None, **keywords):
    """Survival and escapes of an ensemble: a `carom.Escape`.

    system: a System, the name of a built-in one, or a system file. Keywords: keys of a system file
    (t_max, trajectories, seed, times, B, larmor_radius, speed, initial, …) and threads, isa,
    engine. progress: True, False, a function of (share, number done), or None: on a terminal.
    Ctrl-C raises KeyboardInterrupt, whose `result` holds what was done.
    """
    return _compute(
        results.Escape, _carom.escape, system, "escape", keywords, progress, per_trajectory
    )


def diffusion(system, *, per_trajectory=False, progress=None, **keywords):
    """Mean square displacement and diffusion coefficient: a `carom.Diffusion`."""
    return _compute(
        results.Diffusion, _carom.diffusion, system, "diffusion", keywords, progress, per_trajectory
    )


def run(system, *, state_error=True, progress=None, **keywords):
    """One trajectory, followed closely: a `carom.Run`.

    position, velocity: a start; else `initial` of the system, drawn with `trajectory` (0).
    state_error: estimates the error of the state under forces, which costs up to three times the
    run. precision="certified", digits=30: a `carom.Certified`, every digit of which is guaranteed.
    """
    if keywords.get("precision", "double") != "double" or "digits" in keywords:
        return _compute(
            results.Certified, _carom.run_certified, system, "run", keywords, progress
        )
    return _compute(results.Run, _carom.run, system, "run", keywords, progress, state_error)


def section(system, *, progress=None, **keywords):
    """Where orbits meet walls, a line, a circle or a velocity: a `carom.Section`.

    on: "boundary", "wall:NAME", "line:x0,y0:x1,y1", "x=0" …; points: of each orbit; orbits.
    """
    return _compute(results.Section, _carom.section, system, "section", keywords, progress)


_KINDS = {
    "escape": (results.Escape, _carom.open_escape),
    "diffusion": (results.Diffusion, _carom.open_diffusion),
    "run": (results.Run, _carom.open_run),
    "section": (results.Section, _carom.open_section),
}


def open(path):  # noqa: A001: the name that users expect
    """The result that an archive holds: the same classes as of the functions that compute."""
    path = os.fspath(path)
    kind = _carom.kind_of_archive(path)
    if kind not in _KINDS:
        raise InputError(f"'{path}' holds a {kind}", (path, 0, 0, ""), " or ".join(_KINDS))
    made, function = _KINDS[kind]
    outcome = function(path)
    result = made(outcome, System(outcome.system.toml, outcome.system.name))
    result._archive = path
    return result
