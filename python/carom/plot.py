"""Pictures, by matplotlib: tables, orbits, energies, survival, rates, basins, diffusion, sections
(analyses.py: sweeps, exponents, periodic orbits, equilibria, integrators; transport.py: diffusion).

`thing.plot()` chooses among these functions. All of them return the axes, or an array of them where a
picture has several, with their `figure`; all take `ax`. STYLE is the look of new figures.
"""

import re
import warnings

import numpy

from . import _carom
from .analyses import comparison, convergence, equilibria, lyapunov, orbits, spectrum, sweep
from .axes import COLOURS, STYLE
from .axes import colour_bar as _colour_bar
from .axes import colour_map as _colour_map
from .axes import colour_of as _colour_of
from .axes import legend as _legend
from .axes import dots_of as _dots_of
from .axes import new_axes as _new_axes
from .axes import picture as _picture
from .axes import plain as _plain
from .axes import pyplot as _pyplot
from .axes import style_of as _style_of
from .axes import subplots as _subplots
from .axes import symbol as _symbol
from .axes import title as _title
from .axes import title_above as _title_above
from .axes import title_of as _title_of
from .axes import with_error as _with_error
from .errors import InputError, text_of
from .errors import nearest as _nearest
from .tables import WALL as _WALL
from .tables import arrow as _arrow
from .tables import draw_levels as _levels
from .tables import fit as _fit
from .tables import make_room as _make_room
from .tables import table
from .transport import correlation, diffusion, free_paths, returns

__all__ = (
    "STYLE basins comparison convergence correlation diffusion distances energy equilibria escape exponents free_paths"
    " lyapunov orbit orbits pictures rate result returns section spectrum splitting survival sweep table times"
).split()


@_picture
def orbit(run, ax=None, most_hits=2000, names=False, by="particle", **style):
    """The table with the orbit of each particle, from a dot to a ring: arcs are arcs, and an arrow
    shows the direction. Coloured by "particle" or by "time"; style: keywords for the lines, such as color."""
    hits = run.hits[: most_hits * len(run.starts)]
    cells = {(0, 0)}
    for rows in (hits, run._samples):
        cells |= set(zip(rows["cell_first"].tolist(), rows["cell_second"].tolist()))
    cells = cells if len(cells) <= 400 else [(0, 0)]
    made = ax is None
    style = _style_of(style, linewidth=0.7, alpha=0.85)
    colour = style.pop("color", None)
    labelled = "label" in style
    ax = table(run.system, ax=_new_axes(ax), names=names, cells=cells, levels=False, directions=False, starts=0)
    particles = sorted(set(run.starts["particle"].tolist()))
    drawn = False
    lines = []
    for number in particles:
        path = run.path(number)
        times = run.hits["t"][run.hits["particle"] == number]
        if len(times) > most_hits:
            path = path[path["t"] <= times[most_hits]]
            drawn = True
        kept = colour or _colour_of(number, len(particles))
        if by == "time":
            lines.append(path)
            kept = "black"
        else:
            ax.plot(path["x"], path["y"], **({"color": kept, "zorder": 2} | style))
            style.pop("label", None)
        ax.plot(path["x"][:1], path["y"][:1], "o", color=kept, markersize=4, zorder=5)
        ax.plot(path["x"][-1:], path["y"][-1:], "o", color=kept, markersize=5, zorder=5, markerfacecolor="white")
        _direction(ax, path, kept)
    for radius, start in zip(_carom.disc_radii(run._outcome.system), run.starts):
        shade = colour or _colour_of(start["particle"], len(particles))
        disc = _pyplot().Circle((start["x"], start["y"]), radius, color=shade, alpha=0.3, linewidth=0)
        ax.add_patch(disc)
    if by == "time":
        _by_time(lines, ax, style)
    if labelled:
        _legend(ax)
    said = [f"first {most_hits} hits"] if drawn else []
    if run.engine != "events" and not len(run._samples):
        said.append("no samples: straight between hits")
    ax.annotate(
        "\n".join(said), (1, 0), xycoords="axes fraction", xytext=(0, -18), textcoords="offset points",
        fontsize="x-small", ha="right", va="top", color="0.4",
    )  # fmt: skip
    _make_room(ax, 0.04)
    _levels(run.system._loaded("table"), ax)
    if made:
        _fit(ax)
    return ax


def _direction(ax, path, colour):
    """An arrow in the middle of the first flight that is long enough to be seen."""
    points = numpy.stack([path["x"], path["y"]], axis=1)[:200]
    lengths = numpy.hypot(*numpy.diff(points, axis=0).T)
    along = numpy.cumsum(lengths)
    if len(along) and along[-1] > 0:
        last = int(numpy.argmax(along >= min(along[-1], _size(ax) / 8)))
        _arrow(ax, points[: last + 2], colour, 0.6, 9)


def _size(ax):
    return max(float(numpy.diff(ax.get_xlim())[0]), float(numpy.diff(ax.get_ylim())[0]))


def _by_time(lines, ax, style):
    """Paths in colours of their times, with the scale beside them."""
    from matplotlib.collections import LineCollection

    last = max(float(path["t"][-1]) for path in lines)
    for path in lines:
        points = numpy.stack([path["x"], path["y"]], axis=1)
        pieces = LineCollection(
            list(numpy.stack([points[:-1], points[1:]], axis=1)), cmap=_colour_map(), zorder=2,
            **{key: one for key, one in style.items() if key in ("alpha", "label", "linewidth", "linestyle")},
        )  # fmt: skip
        pieces.set_array(path["t"][:-1])
        pieces.set_clim(0.0, last)
        ax.add_collection(pieces)
    _colour_bar(ax, pieces, "t")


@_picture
def energy(run, ax=None, **style):
    """Energies along the run at the times of its samples: the parts, and below them the change of
    their sum since the start; with `ax` the parts. style: keywords for all lines, which then differ by their dashes; a
    label stands before the names of the parts."""
    rows = run._energies
    if not len(rows):
        raise InputError("no energies are stored: they need forces or hard discs, and carom.run(…, sample=0.1)",
                         ("", 0, 0, "sample"), "a run with sample")  # fmt: skip
    style = _style_of(style, linewidth=1)
    before = f"{style.pop('label')}: " if "label" in style else ""
    axes = ax
    if ax is None:
        _, axes = _subplots(2, 1, figsize=(5.0, 4.2), sharex=True, height_ratios=(2, 1))
        ax, below = axes
        below.plot(rows["t"], rows["total"] - rows["total"][0], **({"color": _WALL} | style | {"linewidth": 0.8}))
        below.set(xlabel="$t$", ylabel="change of total")
    else:
        ax.set_xlabel("$t$")
    dashes = ("--", ":", "-.", "-") if "color" in style else 4 * ("-",)
    for name, shade, dash in zip(("kinetic", "external", "pair", "total"), (*COLOURS[:3], _WALL), dashes):
        if name in ("kinetic", "total") or rows[name].any():
            usual = {"color": shade, "linestyle": dash, "label": before + name}
            ax.plot(rows["t"], rows[name], **(usual | style))
    ax.set_ylabel("energy")
    ax.margins(y=0.1)
    _legend(ax, fontsize="small", ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    ax.set_title(_title_of(run.system), pad=22, fontsize=9)
    return axes


@_picture
def survival(result, ax=None, scale="log", **style):
    """p(t) with its 95 % interval, and the decay that was fitted, in its window; scale of time: "log"
    (for tails) or "linear" (for rates); style: keywords for the line, such as color and label."""
    ax = _new_axes(ax)
    points = result.survival
    seen = points[(points["p"] > 0) & ((points["t"] > 0) | (scale == "linear"))]
    low = numpy.maximum(seen["low"], seen["p"].min() * 1e-3 if len(seen) else 1e-300)
    _with_band(ax, seen["t"], seen["p"], low, seen["high"], style)
    ax.set(xscale=scale, yscale="log", xlabel="$t$", ylabel="$p(t)$")
    _decay(ax, result.fit, style)
    bottom, top = ax.get_ylim()
    if bottom > 0.1:  # powers of ten say little
        ax.set_ylim(min(bottom, 0.5), max(top, 1.1), auto=True)
        ax.yaxis.set_major_formatter("{x:g}")
        ax.yaxis.set_minor_formatter("{x:g}")
    _title(ax, result.system)
    return ax


def _with_band(ax, t, values, low, high, style):
    style = _style_of(style, color=COLOURS[0], linewidth=1, markersize=3)
    ax.fill_between(t, low, high, color=style["color"], alpha=0.25, linewidth=0)
    ax.plot(t, values, "o-", **style)
    if not len(t):
        ax.annotate("all values are zero", (0.5, 0.5), xycoords="axes fraction", ha="center", color="0.4")
    if "label" in style:
        _legend(ax)


def _decay(ax, fit, style):
    """The line of the likeliest decay; beside curves that have a colour it is black, and begins with their label."""
    if fit.model is None:
        return
    t = numpy.linspace(*fit.window, 200)
    exponential = fit.model.startswith("exponential")
    law = numpy.exp(-fit.rate * t) if exponential else t**-fit.exponent
    p = fit.amplitude * law + (fit.plateau if "plateau" in fit.model else 0.0)
    name, value = ("κ", fit.rate) if exponential else ("exponent", fit.exponent)
    kind = f"local slope, {fit.model}" if fit.local_slope else fit.model
    # In short lines, so that it finds a place beside the curve.
    label = f"{kind}\n{name} = {_with_error(value, fit.stderr)}" + ("" if fit.decided else ", undecided")
    style = _style_of(style)
    label = f"{style['label']}: {label}" if "label" in style else label
    colour, dashes = ("0.1", "--") if "color" in style else (COLOURS[1], "-")
    ax.plot(t, p, dashes, color=colour, linewidth=1.5, zorder=3, label=label)
    _legend(ax, fontsize="x-small")


@_picture
def rate(result, ax=None, scale=None, **style):
    """The escape rate −dp/dt with its 95 % interval; scale of time: "log" or "linear", if not given
    what its range asks for; style: keywords for the line, such as color and label."""
    ax = _new_axes(ax)
    seen = result.rate[result.rate["value"] > 0]
    seen = seen[seen["t"] > 0]
    if scale is None:
        scale = "log" if len(seen) and seen["t"].max() > 30 * seen["t"].min() else "linear"
    low = numpy.maximum(seen["low"], seen["value"].min() * 1e-3 if len(seen) else 1e-300)
    _with_band(ax, seen["t"], seen["value"], low, seen["high"], style)
    ax.set(xscale=scale, yscale="log", xlabel="$t$", ylabel="$-dp/dt$")
    _title(ax, result.system)
    return ax


@_picture
def basins(result, ax=None, colour=None, x=None, y=None, size=None, **style):
    """Starts with per_trajectory, coloured by what becomes of them: "hole", "time" (of the end) or
    "hits"; for exponents also "lambda" or "sali". x and y: columns of its rows, such as "x", "y",
    "vx", "vy"; default: s and v_parallel of starts on walls, else the plane. Starts that
    lie on no wall have no s and v_parallel: they are left out with a warning, and refused if all do.
    style: alpha and label; with color all starts are dots of one colour."""
    style = _style_of(style)
    rows = result.per_trajectory
    if rows is None:
        raise ValueError("no starts are stored: carom.escape(…, per_trajectory=True)")
    if x is None and y is None:
        x, y = ("s", "v_parallel") if len(rows) and (rows["wall"] >= 0).all() else ("x", "y")
    x, y = x or "x", y or "y"
    in_plane = (x, y) == ("x", "y")
    known = numpy.isfinite(rows[x]) & numpy.isfinite(rows[y])
    if not known.all():
        off = f"{numpy.count_nonzero(~known)} of {len(rows)} starts lie on no wall, and have no s and v_parallel"
        if not known.any():
            raise InputError(off, ("", 0, 0, "x"), "starts on walls, or other columns", "x")
        warnings.warn(f"{off}: they are not drawn", stacklevel=2)
        rows = rows[known]
    colour = colour or ("hole" if len(result.system.holes) > 1 else "time")
    made = ax is None
    ax = _new_axes(ax)
    across, up, full = rows[x], rows[y], 1.0
    if in_plane:
        table(result.system, ax=ax, names=False, levels=False, directions=False, starts=0)
        full = min(1.0, float(numpy.divide(*numpy.ptp(ax.dataLim.get_points(), axis=0)[::-1])))
    elif x == "s":
        across = _along_walls(ax, result.system, rows)
    from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, Normalize

    size = size or float(numpy.clip(6e4 * full / max(1, len(rows)), 0.1, 20.0))
    if "color" in style:
        dots = {"s": size, "zorder": 1, "rasterized": len(rows) > 5000}
        ax.scatter(across, up, **(dots | _dots_of(style)))
        if "label" in style:
            _legend(ax)
    elif colour == "hole":
        shades = ["0.8", *(COLOURS[i % len(COLOURS)] for i in range(len(result.system.holes)))]
        norm = Normalize(-1.5, len(shades) - 1.5)
        _cover(ax, across, up, rows["hole"], norm, ListedColormap(shades), size, style)
        for number, name in enumerate(["none", *result.system.holes], -1):
            if (rows["hole"] == number).any():
                ax.scatter([], [], color=shades[number + 1], s=20, label=_plain(name))
        _legend(ax, fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        known = numpy.isfinite(rows[colour])
        values = rows[colour][known]
        seen = values[values > 0] if colour != "lambda" else values[:0]
        wide = len(seen) and seen.max() > 20 * seen.min()
        least = float(numpy.quantile(seen, 0.005)) if wide else 0.0  # few starts need no share of the colours
        norm = LogNorm(least, seen.max()) if wide else Normalize()
        bar = {"extend": "min" if wide and seen.min() < least else "neither"}
        if colour == "hits" and len(values) and numpy.ptp(values) < 12:
            bar = {"ticks": numpy.arange(values.min(), values.max() + 1)}
            norm = BoundaryNorm(numpy.arange(values.min() - 0.5, values.max() + 1), 256)
        values = numpy.maximum(values, least) if wide else values
        drawn = _cover(ax, across[known], up[known], values, norm, _colour_map(), size, style)
        _colour_bar(ax, drawn, colour, **bar)
    _title(ax, result.system)
    if not in_plane:
        ax.set(xlabel=_symbol(x), ylabel=_symbol(y))
        ax.margins(0.0)
    elif made:
        _fit(ax)
    return ax


def times(result, ax=None, **keywords):
    """Starts coloured by the time of their end: `basins` with colour="time"."""
    return basins(result, ax=ax, colour="time", **keywords)


def exponents(result, ax=None, **keywords):
    """Starts coloured by the exponents of their orbits: `basins` with colour="lambda"."""
    return basins(result, ax=ax, colour="lambda", **keywords)


def _lines_of(places):
    """Places without their rounding, and which of them each is."""
    span = numpy.ptp(places) if len(places) else 0.0
    step = span * 1e-9 if span > 0 else 1.0
    steps, which = numpy.unique(numpy.round(places / step), return_inverse=True)
    return steps * step, which


def _cover(ax, x, y, values, norm, cmap, size, style):
    """Colours at points: cells where these are a grid, else dots."""
    columns, i = _lines_of(x)
    lines, j = _lines_of(y)
    if len(columns) * len(lines) == len(x) and len(columns) > 1 and len(lines) > 1:
        cells = numpy.full((len(lines), len(columns)), numpy.nan)
        cells[j, i] = values
        if not numpy.isnan(cells).any():
            return ax.pcolormesh(
                columns, lines, cells, norm=norm, cmap=cmap, shading="nearest", zorder=1, rasterized=True,
                alpha=style.get("alpha"),
            )  # fmt: skip
    dots = {"s": size, "zorder": 1, "rasterized": len(x) > 5000}
    return ax.scatter(x, y, c=values, norm=norm, cmap=cmap, **(dots | _dots_of(style)))


@_picture
def escape(result, ax=None, **style):
    """Survival twice: against log t (power laws are straight) and against t (exponentials are); with `ax`
    against log t."""
    if ax is not None:
        return survival(result, ax=ax, **style)
    figure, axes = _subplots(1, 2, figsize=(8.0, 3.6))
    for one, scale in zip(axes, ("log", "linear")):
        survival(result, one, scale, **style).set_title("")
    _title_above(figure, result.system)
    return axes


@_picture
def splitting(result, ax=None, **style):
    """Survival by splitting with its 95 % interval, against time or the number of hits, and the decay that was
    fitted; style: keywords for the line, such as color and label."""
    ax = _new_axes(ax)
    x, name = ("n", "survival_hits") if "survival_hits" in result.json else ("t", "survival")
    rows = [row for row in result.json[name] if row["value"]]
    places, values, low, high = ([row[key] for row in rows] for key in (x, "value", "low", "high"))
    _with_band(ax, places, values, low, high, style)
    _decay(ax, result.fit, style)
    ax.set(yscale="log", xlabel="hits" if x == "n" else "$t$", ylabel=f"$p({x})$")
    _title(ax, result.system)
    return ax


@_picture
def section(result, ax=None, x=None, y=None, **style):
    """Points in colour by orbit: (s, v∥) over the walls, one after the other, or along a line or
    circle; (x, y) for a condition on the velocity. Other columns by `x` and `y`. style: keywords for the dots, such as
    color, label and markersize."""
    ax = _new_axes(ax, (6.0, 4.2))
    style = _style_of(style)
    points = result.points
    at_walls = len(points) == 0 or (points["wall"] >= 0).all()
    if x is None and at_walls:
        across = _along_walls(ax, result.system, points)
        up, label_x, label_y = points["v_parallel"], "s", "v_parallel"
    else:
        along = points["s"].any() or points["v_parallel"].any()
        if x is None and y is None and along:  # on a line x = c or y = c the place and the velocity along it
            axis = re.search(r'^on = "([xy])=', result.system.to_toml(), re.MULTILINE)
            x, y = {"x": ("y", "vy"), "y": ("x", "vx")}.get(axis and axis[1], (None, None))
        label_x, label_y = x or ("s" if along else "x"), y or ("v_parallel" if along else "y")
        across, up = points[label_x], points[label_y]
    orbits = points["orbit"].astype(int)
    colours = numpy.array(COLOURS)[orbits % len(COLOURS)]
    size = float(numpy.clip(2e4 / max(1, len(points)), 0.05, 6.0))
    dots = {"s": size, "rasterized": len(points) > 20000} | ({} if "color" in style else {"c": colours})
    ax.scatter(across, up, **(dots | _dots_of(style)))
    if "label" in style:
        _legend(ax)
    ax.set(xlabel=_symbol(label_x), ylabel=_symbol(label_y))
    _title(ax, result.system)
    return ax


def _along_walls(ax, system, rows):
    """Where rows lie along the walls, which follow each other from the first to the last that has some, with their
    names above."""
    walls = system._table()["walls"]
    names = 1 < len(walls) <= 12
    first, last = (rows["wall"].min(), rows["wall"].max()) if len(rows) else (0, len(walls) - 1)
    walls = walls[first : last + 1]
    edges = numpy.concatenate([[0.0], numpy.cumsum([wall["length"] for wall in walls])])
    if names:
        for edge in edges[1:-1]:
            ax.axvline(edge, color="0.8", linewidth=0.6, zorder=0)
        top = ax.secondary_xaxis("top")
        top.set_xticks((edges[:-1] + edges[1:]) / 2, [_plain(wall["name"]) for wall in walls])
        top.tick_params(length=0, labelsize=7)
    ax.set_xlim(0.0, edges[-1])
    return rows["s"] + edges[rows["wall"].astype(int) - first]


@_picture
def distances(result, ax=None, **style):
    """How far each case of `carom.validate` is from its expected value, in standard errors; the bands are one and
    three. 68 % and 99.7 % of independent cases without bias lie in them. style: keywords for the cases that passed."""
    style = _style_of(style, color=COLOURS[0], marker="o", linestyle="")
    ax = _new_axes(ax, (8.0, 3.6))
    cases = result.cases[(result.cases["error"] > 0) | (result.cases["expected_error"] > 0)]
    for reach, colour in ((3, "#e8eff5"), (1, "#c9dcec")):
        ax.axhspan(-reach, reach, color=colour, linewidth=0, zorder=0)
    place = numpy.arange(len(cases))
    for passed, look in ((True, style), (False, style | {"color": "#b3261e", "label": None})):
        these = cases["passed"] == passed
        ax.plot(place[these], numpy.clip(cases["sigma"][these], -5, 5), **look)
    if "label" in style:
        _legend(ax)
    ax.set(ylim=(-5.5, 5.5), xlabel="case", ylabel="distance / standard error")
    return ax


def pictures(result):
    """The pictures that there are of a result or a system, by name; the first is the one that
    `result.plot()` draws."""
    return getattr(result, "_pictures", dict)()


def no_picture(thing, what, there):
    """The error for a name that is none of the pictures `there`."""
    names = " or ".join(there)
    return InputError(
        f"{thing} has no picture '{what}': choose {names}", ("", 0, 0, "what"), names, _nearest(what, there)
    )


def result(result, ax=None, what=None, **keywords):
    """A picture of a result: the one named `what` of `carom.plot.pictures(result)`, else the first."""
    there = pictures(result)
    if not there:
        raise NotImplementedError(f"a {type(result).__name__} has no picture")
    what = text_of(what, "what") if what is not None else next(iter(there))
    if what not in there:
        raise no_picture(f"a carom.{type(result).__name__}", what, there)
    return there[what](result, ax=ax, **keywords)
