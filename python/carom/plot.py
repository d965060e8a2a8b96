"""Pictures, by matplotlib: tables, orbits, survival, diffusion, sections.

`thing.plot()` chooses among these functions; all of them return the axes and take `ax`.
Colours can be told apart by people who see few of them (Okabe and Ito).
"""

import textwrap

import numpy

from . import _carom

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
_WALL = "#222222"


def _pyplot():
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib (Debian: python3-matplotlib)") from error
    return pyplot


def _axes(ax, size=(5.0, 4.2)):
    if ax is not None:
        return ax
    _, ax = _pyplot().subplots(figsize=size, layout="constrained")
    return ax


def _title_of(system, width=56):
    return textwrap.fill(system.title or system.name, width)


def _title(ax, system):
    ax.set_title(_title_of(system), fontsize="small")


def table(system, ax=None, names=True, cells=((0, 0),), levels=True):
    """Walls, holes (dashed, with their names) and level lines of the potentials; of a lattice these
    cells."""
    ax = _axes(ax)
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
    for _, _, holes in walls:
        for hole_name, piece in holes:
            if names and len(system.holes) <= 8:
                _label(ax, piece[len(piece) // 2], hole_name, COLOURS[1])
    if names and len(walls) <= 12:
        for name, pieces, _ in walls:
            if pieces:
                longest = max(pieces, key=len)
                middle = longest[len(longest) // 2] if len(longest) > 2 else longest.mean(axis=0)
                _label(ax, middle, name, "0.45")
    if levels:
        _levels(system, loaded, ax)
    ax.set_aspect("equal")
    ax.set_xlabel("x")
    ax.set_ylabel("y")
    _title(ax, system)
    return ax


def _label(ax, at, text, colour):
    ax.annotate(
        text, at, color=colour, fontsize="x-small", ha="center", va="center", zorder=5,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.8},
    )


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


def orbit(run, ax=None, most_hits=2000, colour=None, names=False):
    """The table with the orbit of each particle: arcs are arcs."""
    hits = run.hits[: most_hits * len(run.starts)]
    cells = {(0, 0), *zip(hits["cell_first"].tolist(), hits["cell_second"].tolist())}
    cells = cells if len(cells) <= 400 else [(0, 0)]
    ax = table(run.system, ax=_axes(ax), names=names, cells=cells, levels=False)
    particles = sorted(set(run.starts["particle"].tolist()))
    drawn = False
    for number in particles:
        path = run.path(number)
        times = run.hits["t"][run.hits["particle"] == number]
        if len(times) > most_hits:
            path = path[path["t"] <= times[most_hits]]
            drawn = True
        kept = colour or COLOURS[number % len(COLOURS)]
        ax.plot(path["x"], path["y"], color=kept, linewidth=0.7, zorder=2)
        ax.plot(path["x"][:1], path["y"][:1], "o", color=kept, markersize=3.5, zorder=4)
    if drawn:
        ax.annotate(
            f"the first {most_hits} hits", (1, 0), xycoords="axes fraction", fontsize="x-small",
            ha="right", va="bottom", color="0.4",
        )
    _levels(run.system, run.system._loaded("table"), ax)
    return ax


def survival(result, ax=None, scale="log"):
    """p(t) with its 95 % interval; scale of time: "log" (for tails) or "linear" (for rates)."""
    ax = _axes(ax)
    points = result.survival
    seen = points[(points["p"] > 0) & ((points["t"] > 0) | (scale == "linear"))]
    low = numpy.maximum(seen["low"], seen["p"].min() * 1e-3 if len(seen) else 1e-300)
    ax.fill_between(seen["t"], low, seen["high"], color=COLOURS[0], alpha=0.25, linewidth=0)
    ax.plot(seen["t"], seen["p"], "o-", color=COLOURS[0], markersize=3, linewidth=1)
    ax.set_yscale("log")
    ax.set_xscale(scale)
    ax.set_xlabel("t")
    ax.set_ylabel("p(t)")
    _title(ax, result.system)
    return ax


def escape(result, ax=None):
    """Survival twice: against log t (power laws are straight) and against t (exponentials are)."""
    if ax is not None:
        return survival(result, ax=ax)
    figure, axes = _pyplot().subplots(1, 2, figsize=(8.0, 3.6), layout="constrained")
    for one, scale in zip(axes, ("log", "linear")):
        survival(result, one, scale).set_title("")
    figure.suptitle(_title_of(result.system, 90), fontsize="small")
    return axes


def diffusion(result, ax=None):
    """The mean square displacement with its errors, and 4Dt where there is a D without a doubt."""
    ax = _axes(ax)
    points = result.msd
    seen = points[(points["t"] > 0) & (points["value"] > 0)]
    ax.errorbar(
        seen["t"], seen["value"], yerr=seen["stderr"], fmt="o", markersize=3, linewidth=1,
        color=COLOURS[0], label="MSD",
    )
    if result.D is not None and "note" not in result.json:
        ax.plot(
            seen["t"], 4 * result.D.value * seen["t"], color=COLOURS[1], linewidth=1,
            label=f"4 D t, D = {result.D.value:.4g} ± {result.D.stderr:.1g}",
        )
    if result.exponent is not None:
        ax.plot([], [], " ", label=f"exponent {result.exponent.value:.4g} ± {result.exponent.stderr:.1g}")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("t")
    ax.set_ylabel("⟨|x(t) − x(0)|²⟩")
    ax.legend(fontsize="small", frameon=False)
    _title(ax, result.system)
    return ax


def section(result, ax=None, x=None, y=None):
    """Points in colour by orbit: (s, v∥) over the walls, one after the other, or along a line or
    circle; (x, y) for a condition on the velocity. Other columns by `x` and `y`."""
    ax = _axes(ax, (6.0, 4.2))
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
            top.set_xticks((starts[:-1] + starts[1:]) / 2, [wall["name"] for wall in walls])
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


def result(result, ax=None, **keywords):
    """What there is to see of a result."""
    from . import results

    draw = {
        results.Run: orbit, results.Escape: escape, results.Diffusion: diffusion,
        results.Section: section,
    }[type(result)]
    return draw(result, ax=ax, **keywords)
