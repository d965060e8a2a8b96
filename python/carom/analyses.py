"""Pictures of analyses: sweeps, Lyapunov exponents, periodic orbits, equilibria, integrators."""

import numpy

from . import _carom
from .axes import COLOURS, new_axes, plain, title
from .errors import InputError


def sweep(result, ax=None, y=None):
    """A column of a sweep's table against its key, with error bars; of a plane a map. y: the column
    (default: the first with errors)."""
    table = result.table
    keys = [one["key"] for one in result._json["keys"]]
    numbers = [name for name in table.dtype.names if table[name].dtype.kind == "f"]
    if y is None:
        others = [name for name in numbers if name not in keys]
        with_errors = [name for name in others if f"{name}_stderr" in numbers]
        if not others:
            raise InputError("no value of the sweep has a number to draw; its reports say why")
        y = (with_errors or others)[0]
    ax = new_axes(ax)
    if len(keys) == 1:
        known = numpy.isfinite(table[y])
        error = table[f"{y}_stderr"][known] if f"{y}_stderr" in numbers else None
        ax.errorbar(
            table[keys[0]][known], table[y][known], yerr=error, fmt="o-", markersize=4, linewidth=1,
            capsize=2, color=COLOURS[0],
        )  # fmt: skip
        ax.set(xlabel=plain(keys[0]), ylabel=y)
    else:
        first, second = (numpy.unique(table[key]) for key in keys)
        values = numpy.full((len(first), len(second)), numpy.nan)
        values[numpy.searchsorted(first, table[keys[0]]), numpy.searchsorted(second, table[keys[1]])] = table[y]
        colours = ax.pcolormesh(first, second, values.T, shading="nearest")
        ax.figure.colorbar(colours, ax=ax, label=y)
        ax.set(xlabel=plain(keys[0]), ylabel=plain(keys[1]))
    title(ax, result.system)
    return ax


def lyapunov(result, ax=None):
    """How the finite-time exponents of the orbits are distributed, and their mean."""
    ax = new_axes(ax)
    bins = result.distribution
    if len(bins):
        edges, counts = _coarser(bins)
        ax.stairs(counts / (counts.sum() * numpy.diff(edges)), edges, fill=True, color=COLOURS[0])
        ax.ticklabel_format(useOffset=False)
    if result.lambda_ is not None:
        value, error = (result.lambda_[0][key] for key in ("value", "stderr"))
        known = error is not None and error > 0
        ax.axvline(
            value, color=COLOURS[1], linewidth=1,
            label=f"λ = {value:.5g}" + (f" ± {error:.1g}" if known else ""),
        )  # fmt: skip
        ax.margins(y=0.15)
        ax.legend(fontsize="small", frameon=False)
    ax.set_xlabel("exponent of an orbit")
    ax.set_ylabel("density")
    title(ax, result.system)
    return ax


def spectrum(result, ax=None):
    """All exponents, the largest first, with their errors."""
    ax = new_axes(ax)
    values = result.spectrum
    if values is not None:
        number = numpy.arange(1, len(values) + 1)
        ax.axhline(0, color="0.8", linewidth=0.8, zorder=0)
        ax.errorbar(
            number, values["value"], yerr=values["stderr"], fmt="o", markersize=4, capsize=2,
            linewidth=1, color=COLOURS[0],
            label=f"entropy {result.entropy.value:.4g}: sum of the positive ones",
        )  # fmt: skip
        ax.legend(fontsize="small", frameon=False)
        ax.xaxis.get_major_locator().set_params(integer=True)
    ax.set(xlabel="number of the exponent", ylabel="exponent")
    title(ax, result.system)
    return ax


def _coarser(bins):
    """Edges and counts of bins, so many taken together that about twice the cube root of the number
    of orbits are left (Rice's rule)."""
    together = max(1, round(len(bins) / max(4.0, 2 * bins["count"].sum() ** (1 / 3))))
    starts = numpy.arange(0, len(bins), together)
    edges = numpy.append(bins["from"][starts], bins["to"][-1])
    return edges, numpy.add.reduceat(bins["count"], starts)


def orbits(result, ax=None, most=12):
    """The table with periodic orbits, the first `most` of them; of families one member. Of a lattice
    all cells that they cross."""
    from .plot import table

    cells = {(0, 0)}
    for one in result.json["orbits"][:most]:
        steps = [point.get("step", (0, 0)) for point in one["points"]]
        cells |= {tuple(cell) for cell in numpy.cumsum([(0, 0), *steps], axis=0).tolist()}
    ax = table(
        result.system, ax=ax, names=False, levels=False, directions=False, starts=0, cells=sorted(cells)
    )
    (omega,) = _carom.omegas(result._outcome.system)
    for number, rows in enumerate(result.paths[:most]):
        path = _carom.path(rows, omega)
        family = result.json["orbits"][number]["family"]
        ax.plot(
            path["x"], path["y"], color=COLOURS[number % len(COLOURS)], linewidth=0.9, zorder=2,
            linestyle="--" if family else "-",
        )  # fmt: skip
    return ax


def comparison(result, ax=None, of="error_state"):
    """Error against work: a line for each scheme, in colour by order; dashed: adaptive. Other
    errors by `of`. A dotted line is the wanted error, the grey band what the reference cannot tell."""
    ax = new_axes(ax, (6.6, 4.6))
    runs = result.schemes
    orders = {row["scheme"]: row["stated"] for row in result.measured}
    steps = sorted({order for order in orders.values() if order == order})
    markers = "osD^vPX*"
    used = {}
    for name, order in orders.items():
        rows = runs[(runs["scheme"] == name) & (runs[of] > 0)]
        colour = COLOURS[steps.index(order) % len(COLOURS)] if order in steps else COLOURS[-1]
        used[colour] = used.get(colour, -1) + 1
        adaptive = "tolerance" in runs.dtype.names and (rows["tolerance"] > 0).any()
        ax.plot(
            rows["force_evaluations"], rows[of], "--" if adaptive else "-", color=colour, label=name,
            marker=markers[used[colour] % len(markers)], markersize=3.5, linewidth=1,
        )  # fmt: skip
    if of == "error_state":
        ax.axhline(result.error, color="0.5", linewidth=0.8, linestyle=":")
        ax.axhspan(0, result.reference.error, color="0.92", linewidth=0)
        ax.set_ylim(bottom=result.reference.error / 10)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("force evaluations")
    ax.set_ylabel(of.replace("_", " of the ") if of.startswith("error_") else of)
    ax.legend(fontsize="x-small", frameon=False, loc="center left", bbox_to_anchor=(1, 0.5))
    title(ax, result.system)
    return ax


def equilibria(found, ax=None, most=4):
    """The places of the particles at the lowest equilibria, over the level lines of the potential."""
    from .plot import table

    ax = table(found.system, ax=ax, names=False, directions=False, starts=0)
    shown = found.equilibria[:most]
    for number, one in enumerate(shown):
        x, y = numpy.array(one.positions).T
        ax.plot(
            x, y, "o", color=COLOURS[number % len(COLOURS)], markersize=8 - 1.5 * number, zorder=5 + number,
            markeredgecolor="white", label=f"{one.kind}, {one.energy:.8g}",
        )  # fmt: skip
    if shown:
        places = numpy.concatenate([numpy.array(one.positions) for one in shown])
        room = 0.3 * max(numpy.ptp(places, axis=0).max(), 1e-300)
        if not len(found.system.walls):
            ax.set_xlim(places[:, 0].min() - room, places[:, 0].max() + room)
            ax.set_ylim(places[:, 1].min() - room, places[:, 1].max() + room)
        ax.legend(
            fontsize="x-small", title="energy", title_fontsize="x-small", loc="upper left",
            bbox_to_anchor=(1.0, 1.0), frameon=False,
        )  # fmt: skip
    return ax
