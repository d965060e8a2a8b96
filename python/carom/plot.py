"""Pictures, by matplotlib: tables, orbits, energies, survival, rates, basins, diffusion, sections
(analyses.py: sweeps, exponents, periodic orbits, equilibria, integrators; transport.py: diffusion).

`thing.plot()` chooses among these functions; all of them return the axes and take `ax`.
Colours can be told apart by people who see few of them (Okabe and Ito).
"""

import warnings

import numpy

from . import _carom
from .analyses import comparison, equilibria, lyapunov, orbits, spectrum, sweep
from .axes import COLOURS
from .axes import new_axes as _new_axes
from .axes import plain as _plain
from .axes import pyplot as _pyplot
from .axes import title as _title
from .axes import title_of as _title_of
from .errors import InputError, text_of
from .system import System
from .transport import correlation, diffusion, free_paths, returns

_WALL = "#222222"


def table(
    system, ax=None, names=True, cells=((0, 0),), levels=True, directions=True, field=True, starts=None
):
    """Walls with the direction of their arc length, holes (dashed, with their names), the sense of
    the field, level lines of the potentials; of a lattice these cells. starts: this many
    trajectories' starts as dots with their directions; None: those that the system lists."""
    made = ax is None
    ax = _new_axes(ax)
    loaded = system._loaded("table")
    walls = _carom.walls(loaded)
    for shift in _carom.translations(loaded, list(cells)):
        for edge in _carom.cell(loaded):
            ax.plot(*(edge + shift).T, color="0.6", linewidth=0.8, linestyle=":", zorder=1)
        for _, pieces, holes in walls:
            for piece in pieces:
                ax.plot(*(piece + shift).T, color=_WALL, linewidth=1.4, zorder=3)
            for _, piece in holes:
                hole = {"color": COLOURS[1], "linewidth": 1.4, "linestyle": (0, (2, 1.5))}
                ax.plot(*(piece + shift).T, zorder=3, **hole)
    if levels:
        _levels(system, loaded, ax)
    if starts is None:
        starts = min(_carom.listed(loaded), 100)
    if starts:
        _starts(_carom.starts(loaded, starts), ax)
    ax.set_aspect("equal")
    ax.set_xlabel("x")
    ax.set_ylabel("y")
    _title(ax, system)
    if made:
        _fit(ax)
    if directions and len(walls) <= 12:
        for _, pieces, _ in walls:
            if pieces:
                _arrow(ax, max(pieces, key=len))
    if field:
        _field(loaded, ax)
    if names:
        labels = [(h, piece[len(piece) // 2], COLOURS[1]) for _, _, hs in walls for h, piece in hs]
        if len(walls) <= 12:
            for name, pieces, _ in walls:
                if pieces:
                    labels.append((name, _at(max(pieces, key=len), 0.5), "0.45"))
        _labels(ax, labels)
    return ax


def _at(points, share):
    """The point of a piece of wall after this share of it."""
    steps = numpy.hypot(*numpy.diff(points, axis=0).T)
    along = numpy.concatenate([[0.0], numpy.cumsum(steps)])
    where = share * along[-1]
    return numpy.array([numpy.interp(where, along, points[:, i]) for i in (0, 1)])


def _fit(ax):
    """A figure as high as its table."""
    width, height = numpy.diff(ax.get_xlim())[0], numpy.diff(ax.get_ylim())[0]
    ax.figure.set_size_inches(5.0, float(numpy.clip(0.8 + 4.2 * height / width, 1.8, 6.5)))


def _arrow(ax, piece):
    """The direction of arc length, at three quarters of a piece of wall."""
    tip, foot = _at(piece, 0.76), _at(piece, 0.74)
    style = {"arrowstyle": "-|>", "color": _WALL, "linewidth": 0, "mutation_scale": 11, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tip, foot, arrowprops=style, zorder=4)


def _field(loaded, ax):
    """The sense in which particles turn, and how fast."""
    omegas = sorted({omega for omega in _carom.omegas(loaded) if omega})
    if not omegas:
        return
    sense = "clockwise" if omegas[0] > 0 else "counter-clockwise"
    sense = sense if omegas[0] * omegas[-1] > 0 else "both ways"
    rate = f"ω = {omegas[0]:.4g}" + (f" … {omegas[-1]:.4g}" if len(omegas) > 1 else "")
    ax.annotate(
        f"{rate}, {sense}", (1, 0), xycoords="axes fraction", xytext=(0, -22),
        textcoords="offset points", fontsize="x-small", ha="right", va="top", color="0.35",
    )  # fmt: skip


def _starts(rows, ax):
    ax.quiver(
        *rows.T, color=COLOURS[0], angles="xy", pivot="tail", width=0.004, scale=28, zorder=4, alpha=0.8
    )
    ax.plot(rows[:, 0], rows[:, 1], "o", color=COLOURS[0], markersize=2.5, zorder=4)


def _labels(ax, labels):
    """Names at points; one that would cover another, or that would be among too many, is left out."""
    labels = labels[:40]
    texts = [_label(ax, at, text, colour) for text, at, colour in labels]
    if not texts:
        return
    figure = ax.get_figure()
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    kept = []
    for text in texts:
        box = text.get_window_extent(renderer).expanded(1.05, 1.1)
        if any(box.overlaps(other) for other in kept):
            text.remove()
        else:
            kept.append(box)


def _label(ax, at, text, colour):
    return ax.annotate(
        _plain(text), at, color=colour, fontsize="x-small", ha="center", va="center", zorder=5,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )  # fmt: skip


def _levels(system, loaded, ax):
    low_x, high_x = ax.get_xlim()
    low_y, high_y = ax.get_ylim()
    if not ax.has_data():  # the open plane
        low_x, high_x, low_y, high_y = -2.0, 2.0, -2.0, 2.0
    xs, ys = numpy.linspace(low_x, high_x, 201), numpy.linspace(low_y, high_y, 201)
    energies = _carom.potential(loaded, list(xs), list(ys))
    if energies is None or not numpy.isfinite(energies).any():
        return
    finite = energies[numpy.isfinite(energies)]
    levels = numpy.unique(numpy.quantile(finite, numpy.linspace(0.05, 0.95, 11)))
    if len(levels) > 1:
        ax.contour(xs, ys, energies, levels=levels, colors="0.7", linewidths=0.6, zorder=0)
        ax.set(xlim=(low_x, high_x), ylim=(low_y, high_y))


def orbit(run, ax=None, most_hits=2000, colour=None, names=False, by="particle"):
    """The table with the orbit of each particle: arcs are arcs. Coloured by "particle" or by
    "time"; `colour`: one for all."""
    hits = run.hits[: most_hits * len(run.starts)]
    cells = {(0, 0), *zip(hits["cell_first"].tolist(), hits["cell_second"].tolist())}
    cells = cells if len(cells) <= 400 else [(0, 0)]
    made = ax is None
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
        kept = colour or COLOURS[number % len(COLOURS)]
        if by == "time":
            lines.append((path, ax))
            kept = "black"
        else:
            ax.plot(path["x"], path["y"], color=kept, linewidth=0.7, zorder=2)
        ax.plot(path["x"][:1], path["y"][:1], "o", color=kept, markersize=3.5, zorder=4)
    for radius, start in zip(_carom.disc_radii(run._outcome.system), run.starts):
        shade = colour or COLOURS[start["particle"] % len(COLOURS)]
        disc = _pyplot().Circle((start["x"], start["y"]), radius, color=shade, alpha=0.3, linewidth=0)
        ax.add_patch(disc)
    if by == "time":
        _by_time(lines, ax)
    if drawn:
        ax.annotate(
            f"the first {most_hits} hits", (1, 0), xycoords="axes fraction", fontsize="x-small",
            ha="right", va="bottom", color="0.4",
        )  # fmt: skip
    if run.engine != "events" and not len(run.samples):
        ax.annotate(
            "straight between hits: no samples", (0, 1), xycoords="axes fraction", xytext=(3, -3),
            textcoords="offset points", fontsize="x-small", ha="left", va="top", color="0.4",
        )  # fmt: skip
    _levels(run.system, run.system._loaded("table"), ax)
    if made:
        _fit(ax)
    return ax


def _by_time(lines, ax):
    """Paths in colours of their times, with the scale beside them."""
    from matplotlib.collections import LineCollection

    last = max(float(path["t"][-1]) for path, _ in lines)
    for path, _ in lines:
        points = numpy.stack([path["x"], path["y"]], axis=1)
        pieces = LineCollection(
            list(numpy.stack([points[:-1], points[1:]], axis=1)), cmap="viridis", linewidths=0.8, zorder=2
        )
        pieces.set_array(path["t"][:-1])
        pieces.set_clim(0.0, last)
        ax.add_collection(pieces)
    ax.autoscale_view()
    ax.figure.colorbar(pieces, ax=ax, shrink=0.8).ax.set_title("t", fontsize="medium")


def energy(run, ax=None):
    """Energies along the run at the times of its samples: the parts, and below them how far their
    sum is from its start."""
    rows = run.energies
    if not len(rows):
        raise ValueError("no energies: they need forces or hard discs, and run.sample")
    if ax is None:
        _, (ax, below) = _pyplot().subplots(
            2, 1, figsize=(5.0, 4.2), sharex=True, height_ratios=(2, 1), layout="constrained"
        )
        below.plot(rows["t"], rows["total"] - rows["total"][0], color=_WALL, linewidth=0.8)
        below.set(xlabel="t", ylabel="change of total")
    else:
        ax.set_xlabel("t")
    for name, shade in zip(("kinetic", "external", "pair", "total"), (*COLOURS[:3], _WALL)):
        if name in ("kinetic", "total") or rows[name].any():
            ax.plot(rows["t"], rows[name], color=shade, linewidth=1, label=name)
    ax.set_ylabel("energy")
    ax.margins(y=0.1)
    ax.legend(fontsize="small", frameon=False, ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    ax.set_title(_title_of(run.system), fontsize="small", pad=22)
    return ax


def survival(result, ax=None, scale="log"):
    """p(t) with its 95 % interval, and the decay that was fitted, in its window; scale of time: "log"
    (for tails) or "linear" (for rates)."""
    ax = _new_axes(ax)
    points = result.survival
    seen = points[(points["p"] > 0) & ((points["t"] > 0) | (scale == "linear"))]
    low = numpy.maximum(seen["low"], seen["p"].min() * 1e-3 if len(seen) else 1e-300)
    ax.fill_between(seen["t"], low, seen["high"], color=COLOURS[0], alpha=0.25, linewidth=0)
    ax.plot(seen["t"], seen["p"], "o-", color=COLOURS[0], markersize=3, linewidth=1)
    _decay(ax, result.fit)
    ax.set_yscale("log")
    ax.set_xscale(scale)
    ax.set_xlabel("t")
    ax.set_ylabel("p(t)")
    _title(ax, result.system)
    return ax


def _decay(ax, fit):
    """The line of the likeliest decay."""
    if fit.model is None:
        return
    t = numpy.linspace(*fit.window, 200)
    exponential = fit.model.startswith("exponential")
    law = numpy.exp(-fit.rate * t) if exponential else t**-fit.exponent
    p = fit.amplitude * law + (fit.plateau if "plateau" in fit.model else 0.0)
    name, value = ("κ", fit.rate) if exponential else ("exponent", fit.exponent)
    kind = f"local slope, {fit.model}" if fit.local_slope else fit.model
    label = f"{kind}: {name} = {value:.4g} ± {fit.stderr:.1g}"
    if not fit.decided:
        label += "\n(undecided)"
    ax.plot(t, p, color=COLOURS[1], linewidth=1.5, zorder=3, label=label)
    ax.legend(fontsize="x-small", frameon=False)


def rate(result, ax=None, scale=None):
    """The escape rate −dp/dt with its 95 % interval; scale of time: "log" or "linear", if not given
    what its range asks for."""
    ax = _new_axes(ax)
    seen = result.rate[result.rate["value"] > 0]
    seen = seen[seen["t"] > 0]
    if scale is None:
        scale = "log" if len(seen) and seen["t"].max() > 30 * seen["t"].min() else "linear"
    low = numpy.maximum(seen["low"], seen["value"].min() * 1e-3 if len(seen) else 1e-300)
    ax.fill_between(seen["t"], low, seen["high"], color=COLOURS[0], alpha=0.25, linewidth=0)
    ax.plot(seen["t"], seen["value"], "o-", color=COLOURS[0], markersize=3, linewidth=1)
    ax.set(xscale=scale, yscale="log", xlabel="t", ylabel="−dp/dt")
    _title(ax, result.system)
    return ax


def basins(result, ax=None, colour=None, x=None, y=None, size=None):
    """Starts with per_trajectory, coloured by what becomes of them: "hole", "time" (of the end) or
    "hits"; of exponents also "lambda" or "sali". x and y: columns of its rows, as "x", "y", "vx",
    "vy"; if not given s and v_parallel of starts on one wall in a grid, else the plane. Starts that
    lie on no wall have no s and v_parallel: they are left out with a warning, and refused where all do."""
    rows = result.per_trajectory
    if rows is None:
        raise ValueError("no starts are stored: carom.escape(…, per_trajectory=True)")
    if x is None and y is None:
        at_wall = len(rows) and rows["wall"][0] >= 0 and (rows["wall"] == rows["wall"][0]).all()
        grid = at_wall and result.system.to_toml().count('kind = "birkhoff"') > 0
        x, y = ("s", "v_parallel") if grid else ("x", "y")
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
    if in_plane:
        table(result.system, ax=ax, names=False, levels=False, directions=False, starts=0)
    from matplotlib.colors import ListedColormap, LogNorm, Normalize

    size = size or float(numpy.clip(6e4 / max(1, len(rows)), 0.1, 20.0))
    if colour == "hole":
        shades = ["0.8", *(COLOURS[i % len(COLOURS)] for i in range(len(result.system.holes)))]
        norm = Normalize(-1.5, len(shades) - 1.5)
        _cover(ax, rows[x], rows[y], rows["hole"], norm, ListedColormap(shades), size)
        for number, name in enumerate(["none", *result.system.holes], -1):
            if (rows["hole"] == number).any():
                ax.scatter([], [], color=shades[number + 1], s=20, label=_plain(name))
        ax.legend(fontsize="small", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        rows = rows[numpy.isfinite(rows[colour])]
        values = rows[colour]
        seen = values[values > 0] if colour != "lambda" else values[:0]
        wide = len(seen) and seen.max() > 20 * seen.min()
        norm = LogNorm(seen.min(), seen.max()) if wide else Normalize()
        values = numpy.maximum(values, seen.min()) if wide else values
        drawn = _cover(ax, rows[x], rows[y], values, norm, "viridis", size)
        label = {"time": "time of the end", "hits": "hits", "lambda": "λ", "sali": "SALI"}[colour]
        ax.figure.colorbar(drawn, ax=ax, label=label, shrink=0.9)
    _title(ax, result.system)
    if not in_plane:
        ax.set(xlabel=x, ylabel=y)
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


def _cover(ax, x, y, values, norm, cmap, size):
    """Colours at points: cells where these are a grid, else dots."""
    columns, i = _lines_of(x)
    lines, j = _lines_of(y)
    if len(columns) * len(lines) == len(x) and len(columns) > 1 and len(lines) > 1:
        cells = numpy.full((len(lines), len(columns)), numpy.nan)
        cells[j, i] = values
        if not numpy.isnan(cells).any():
            return ax.pcolormesh(
                columns, lines, cells, norm=norm, cmap=cmap, shading="nearest", zorder=1, rasterized=True
            )
    return ax.scatter(
        x, y, c=values, norm=norm, cmap=cmap, s=size, linewidths=0, zorder=1, rasterized=len(x) > 5000
    )


def escape(result, ax=None):
    """Survival twice: against log t (power laws are straight) and against t (exponentials are)."""
    if ax is not None:
        return survival(result, ax=ax)
    figure, axes = _pyplot().subplots(1, 2, figsize=(8.0, 3.6), layout="constrained")
    for one, scale in zip(axes, ("log", "linear")):
        survival(result, one, scale).set_title("")
    figure.suptitle(_title_of(result.system, 90), fontsize="small")
    return axes


def section(result, ax=None, x=None, y=None):
    """Points in colour by orbit: (s, v∥) over the walls, one after the other, or along a line or
    circle; (x, y) for a condition on the velocity. Other columns by `x` and `y`."""
    ax = _new_axes(ax, (6.0, 4.2))
    points = result.points
    at_walls = len(points) == 0 or (points["wall"] >= 0).all()
    if x is None and at_walls:
        walls = result.system._table()["walls"]
        starts = numpy.concatenate([[0.0], numpy.cumsum([wall["length"] for wall in walls])])
        across = points["s"] + starts[points["wall"]] if len(points) else points["s"]
        up, label_x, label_y = points["v_parallel"], "s", "v∥"
        if 1 < len(walls) <= 12:
            for edge in starts[1:-1]:
                ax.axvline(edge, color="0.8", linewidth=0.6, zorder=0)
            top = ax.secondary_xaxis("top")
            top.set_xticks((starts[:-1] + starts[1:]) / 2, [_plain(wall["name"]) for wall in walls])
            top.tick_params(length=0, labelsize="x-small")
        met = numpy.unique(points["wall"]) if len(points) else [0, len(walls) - 1]
        ax.set_xlim(starts[met[0]], starts[met[-1] + 1])
    else:
        along = points["s"].any() or points["v_parallel"].any()
        label_x, label_y = x or ("s" if along else "x"), y or ("v_parallel" if along else "y")
        across, up = points[label_x], points[label_y]
    orbits = points["orbit"].astype(int)
    colours = numpy.array(COLOURS)[orbits % len(COLOURS)]
    size = float(numpy.clip(2e4 / max(1, len(points)), 0.05, 6.0))
    ax.scatter(across, up, s=size, c=colours, linewidths=0, rasterized=len(points) > 20000)
    ax.set_xlabel(label_x)
    ax.set_ylabel(label_y)
    if not (1 < len(result.system.walls) <= 12 and at_walls):
        _title(ax, result.system)
    return ax


def distances(result, ax=None):
    """How far each case of `carom.validate` is from its expected value, in standard errors; the bands are one and
    three. Of independent cases without bias 68 % and 99.7 % lie in them."""
    ax = _new_axes(ax, (8.0, 3.6))
    cases = result.cases[(result.cases["error"] > 0) | (result.cases["expected_error"] > 0)]
    for reach, colour in ((3, "#e8eff5"), (1, "#c9dcec")):
        ax.axhspan(-reach, reach, color=colour, linewidth=0, zorder=0)
    place = numpy.arange(len(cases))
    for passed, colour in ((True, COLOURS[0]), (False, "#b3261e")):
        these = cases["passed"] == passed
        ax.plot(place[these], numpy.clip(cases["sigma"][these], -5, 5), "o", color=colour)
    ax.set(ylim=(-5.5, 5.5), xlabel="case", ylabel="distance / standard error")
    return ax


def pictures(result):
    """The pictures that there are of a result or a system, by name; the first is the one that
    `result.plot()` draws."""
    from . import results
    from .return_times import Returns
    from .sweep import Sweep

    if isinstance(result, results.Run):
        return {"orbit": orbit} | ({"energy": energy} if len(result.energies) else {})
    if isinstance(result, results.Escape):
        more = {"basins": basins, "times": times} if result.per_trajectory is not None else {}
        return {"survival": escape, "rate": rate} | more
    if isinstance(result, results.Diffusion):
        more = {"free_paths": free_paths} if "free_paths" in result.json else {}
        return {"diffusion": diffusion, "correlation": correlation} | more
    if isinstance(result, results.Lyapunov):
        more = {"exponents": exponents, "times": times} if result.per_trajectory is not None else {}
        whole = {"spectrum": spectrum} if "spectrum" in result.json else {}
        return {"lyapunov": lyapunov} | whole | more
    if isinstance(result, results.Table):
        return {"table": _of_table}
    if isinstance(result, System):
        return {"table": table}
    others = {
        results.Section: section,
        results.Validation: distances,
        results.Equilibria: equilibria,
        results.Comparison: comparison,
        results.Orbits: orbits,
        Returns: returns,
        Sweep: sweep,
    }
    draw = others.get(type(result))
    return {draw.__name__: draw} if draw else {}


def result(result, ax=None, what=None, **keywords):
    """A picture of a result: the one named `what` of `carom.plot.pictures(result)`, else the first."""
    there = pictures(result)
    if not there:
        raise NotImplementedError(f"a {type(result).__name__} has no picture")
    what = text_of(what, "what") if what is not None else next(iter(there))
    if what not in there:
        nearest = _carom.nearest_name(what, list(there))
        raise InputError(
            f"there is no picture '{what}' of {result!r}", ("", 0, 0, "what"), " or ".join(there), nearest
        )
    return there[what](result, ax=ax, **keywords)


def _of_table(measured, ax=None, **keywords):
    return table(measured.system, ax=ax, **keywords)
