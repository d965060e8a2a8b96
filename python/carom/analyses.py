"""Pictures of analyses: sweeps, Lyapunov exponents, periodic orbits, equilibria, integrators."""

import textwrap

import numpy

from . import _carom
from .axes import (
    COLOURS, colour_bar, colour_of, legend, new_axes, picture, plain, scale_of, style_of, subplots, symbol, title,
    title_above, with_error,
)  # fmt: skip
from .errors import InputError
from .tables import table


@picture
def sweep(result, ax=None, y=None, **style):
    """A column of a sweep's table against its key, with error bars; a map for a plane. y: the column
    (default: the first with errors that every value has). Rates and exponents have a marker for each
    law, and no line joins different laws; a hollow marker is undecided."""
    table = result.table
    keys = [one["key"] for one in result._json["keys"]]
    numbers = [name for name in table.dtype.names if table[name].dtype.kind == "f"]
    if y is None:
        others = [name for name in numbers if name not in keys]
        with_errors = [name for name in others if f"{name}_stderr" in numbers]
        if not others:
            raise InputError("no value of the sweep has a number to draw; its reports say why")
        y = max(with_errors or others, key=lambda name: numpy.count_nonzero(numpy.isfinite(table[name])))
    ax = new_axes(ax)
    if len(keys) == 1:
        of_a_law = y in ("rate", "exponent") and "model" in table.dtype.names
        decided = [not of_a_law or one["fit"].get("decided") is not False for one in result._json["sweep"]]
        _line(ax, table, keys[0], y, numpy.array(decided), style)
        ax.set(xlabel=symbol(keys[0]), ylabel=symbol(y))
    else:
        first, second = (numpy.unique(table[key]) for key in keys)
        values = numpy.full((len(first), len(second)), numpy.nan)
        values[numpy.searchsorted(first, table[keys[0]]), numpy.searchsorted(second, table[keys[1]])] = table[y]
        ax.set_facecolor("0.9")  # no value
        alpha = style_of(style).get("alpha")
        colours = ax.pcolormesh(_edges(first), _edges(second), values.T, norm=scale_of(values), alpha=alpha)
        colour_bar(ax, colours, y)
        ax.set(xlabel=symbol(keys[0]), ylabel=symbol(keys[1]))
        for values, scale in ((first, ax.set_xscale), (second, ax.set_yscale)):
            if _geometric(values):
                scale("log")
    title(ax, result.system)
    return ax


def _edges(values):
    """Of cells around values, halfway between them."""
    places = numpy.log(values) if _geometric(values) else values
    middles = (places[1:] + places[:-1]) / 2
    first, last = (middles[0], middles[-1]) if len(middles) else (places[0] - 0.5, places[0] + 0.5)
    edges = numpy.array([2 * places[0] - first, *middles, 2 * places[-1] - last])
    return numpy.exp(edges) if _geometric(values) else edges


def _line(ax, table, key, y, decided, style):
    """Values with errors, in runs without a gap and of one law; hollow where the law is not decided."""
    of_a_law = y in ("rate", "exponent") and "model" in table.dtype.names
    laws = table["model"] if of_a_law else numpy.full(len(table), "")
    order = numpy.argsort(table[key])
    known = numpy.isfinite(table[y])
    names = [law for law in dict.fromkeys(laws[order]) if known[laws == law].any()]
    parts = []
    for i in order:
        joined = parts and known[i] and parts[-1] and laws[parts[-1][-1]] == laws[i]
        if not joined:
            parts.append([])
        if known[i]:
            parts[-1].append(i)
    for part in filter(None, parts):
        number = names.index(laws[part[0]])
        error = table[f"{y}_stderr"][part] if f"{y}_stderr" in table.dtype.names else None
        usual = {"color": COLOURS[number % len(COLOURS)], "label": plain(laws[part[0]]), "markersize": 4}
        usual = style_of(style, marker="osD^vP"[number % 6], **usual)
        if error is not None and y == "survival":  # a share: no bar goes below zero
            error = numpy.array([numpy.minimum(error, table[y][part]), error])
        ax.errorbar(table[key][part], table[y][part], yerr=error, capsize=2, elinewidth=0.9, **usual)
        hollow = [i for i in part if not decided[i]]
        usual |= {"linestyle": "", "markerfacecolor": "white", "label": "undecided", "zorder": 3}
        if hollow:
            ax.plot(table[key][hollow], table[y][hollow], **usual)
    if len(names) > 1 or "label" in style or not decided.all():
        legend(ax)
    if _geometric(table[key][order]):
        ax.set_xscale("log")
    if y == "survival" and scale_of(table[y][known]) == "log":
        ax.set_yscale("log")


def _geometric(values):
    """Have neighbours about the same ratio, over more than a decade?"""
    if len(values) < 4 or values[0] <= 0 or values[-1] < 10 * values[0]:
        return False
    ratios = values[1:] / values[:-1]
    return ratios.max() < 1.5 * ratios.min()


@picture
def lyapunov(result, ax=None, **style):
    """The distribution of the finite-time exponents of the orbits, and their mean. For fewer than ten
    orbits the exponent of each. style: keywords for the distribution, such as color and label."""
    ax = new_axes(ax)
    mean = {"color": style_of(style).get("color", COLOURS[1]), "alpha": style_of(style).get("alpha")}
    labelled = style = style_of(style, color=COLOURS[0], linewidth=1)
    bins = result.distribution
    few = bins["count"].sum() < 10
    if few:
        for one in bins[bins["count"] > 0]:
            ax.axvline((one["from"] + one["to"]) / 2, ymax=0.3, **style)
            style = {key: one for key, one in style.items() if key != "label"}
        ax.set_yticks([])
    elif len(bins):
        edges, counts = _coarser(bins)
        ax.stairs(counts / (counts.sum() * numpy.diff(edges)), edges, fill=True, **style)
        ax.ticklabel_format(useOffset=False)
        ax.margins(y=0.25)
    _exponent_line(ax, result, ax.axvline, ax.axvspan, mean)
    chaotic, share = result.json["chaotic_lambda"], result.json["chaotic_share"]
    if chaotic and share and share["value"] < 1.0 and not few:
        label = f"λ of the chaotic ones = {with_error(chaotic['value'], chaotic['stderr'])}"
        ax.axvline(chaotic["value"], **(mean | {"color": COLOURS[4], "linestyle": "--", "label": label}))
        legend(ax)
    if "label" in labelled:
        legend(ax, fontsize="small")
    ax.set(xlabel="exponent of an orbit", ylabel="" if few else "density")
    title(ax, result.system)
    return ax


@picture
def convergence(result, ax=None, **style):
    """The exponent since the start at growing times (for a repeller: at each kick of its copies), and the final
    value. style: keywords for the line, such as color and label."""
    ax = new_axes(ax)
    own = style_of(style)
    style = style_of(style, marker="o", markersize=4, color=COLOURS[0])
    points = result.convergence
    points = None if points is None else points[numpy.isfinite(points["lambda"])]
    if points is not None and len(points):
        t, value, error = points["t"], points["lambda"], numpy.nan_to_num(points["lambda_stderr"])
        ax.plot(t, value, **style)
        ax.fill_between(t, value - error, value + error, color=style["color"], alpha=0.2, linewidth=0)
    elif result.repeller is not None:
        kicks = result.json["repeller"]["lambda"]["at_kicks"]
        t = result.repeller.kick / 2.0 ** numpy.arange(len(kicks))
        value, error = numpy.array([(one["value"], one["stderr"]) for one in kicks]).T
        ax.errorbar(t, value, yerr=error, capsize=2, **(style | {"linestyle": ""}))
    ax.set_xscale("log")
    own = {"color": own.get("color", COLOURS[1]), "alpha": own.get("alpha")}
    _exponent_line(ax, result, ax.axhline, ax.axhspan, own)
    time = points is not None and len(points) or result.repeller is None
    ax.set(xlabel="$t$" if time else "kick of the copies", ylabel="λ$(t)$" if time else "λ")
    title(ax, result.system)
    return ax


def _exponent_line(ax, result, line, span, style):
    """The exponent of the run with its error, as `line` and `span` draw it."""
    if result.lambda_ is None:
        return
    value, error = result.lambda_[0]
    known = error is not None and error > 0
    line(value, **style, linewidth=1, label=f"λ = {with_error(value, error if known else 0.0)}")
    if known:
        span(value - error, value + error, color=style["color"], alpha=0.2, linewidth=0)
    legend(ax, fontsize="small")


@picture
def spectrum(result, ax=None, **style):
    """All exponents, the largest first, with their errors; style: keywords for the points, such as color and label."""
    ax = new_axes(ax)
    values = result.spectrum
    if values is not None:
        number = numpy.arange(1, len(values) + 1)
        ax.axhline(0, color="0.8", linewidth=0.8, zorder=0)
        ax.errorbar(
            number, values["value"], yerr=values["stderr"], fmt="o", capsize=2,
            **style_of(
                style, markersize=4, linewidth=1, color=COLOURS[0],
                label=f"entropy {with_error(*result.entropy)}: sum of the positive ones",
            ),
        )  # fmt: skip
        legend(ax, fontsize="small")
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


@picture
def orbits(result, ax=None, most=12, **style):
    """Periodic orbits, the first `most` of them, each in its own table with its word, period and the
    larger multiplier; with `ax` all in one. Of a family one member is drawn, dashed; of a lattice all
    cells that an orbit crosses. style: keywords for the lines, such as color."""
    shown = result.json["orbits"][:most]
    style = style_of(style, linewidth=0.9)
    if ax is not None:
        _orbits(result, ax, range(len(shown)), style)
        title(ax, result.system)
        return ax
    across = max(1, min(4, len(shown)))
    down = max(1, -(-len(shown) // across))
    figure, axes = subplots(down, across, squeeze=False)
    for place in axes.flat[max(1, len(shown)) :]:
        place.remove()
    for number, one in enumerate(shown):
        place = axes.flat[number]
        _orbits(result, place, [number], style)
        place.set(xticks=[], yticks=[], xlabel="", ylabel="")
        place.spines[:].set_visible(False)
        real, imaginary = one["multipliers"][0]
        text = f"{textwrap.shorten(one['word'], 24, placeholder='…')}\n$T$ = {with_error(one['period'], None, 5)}"
        if not one["family"]:
            text += f", Λ = {with_error(real, None, 4)}"
            text += f" ± {with_error(imaginary, None)} i" if imaginary else ""
        else:
            text += ", a family"
        place.set_title(text, fontsize=8, pad=2)
    title_above(figure, result.system)
    if not shown:
        _orbits(result, axes[0, 0], [], style)
    heights = [numpy.diff(place.get_ylim())[0] / numpy.diff(place.get_xlim())[0] for place in axes.flat[: len(shown)]]
    letters = [f"{letter} = {wall}" for letter, wall in result.json["letters"].items()]
    names = textwrap.fill(plain(", ".join(letters if 1 < len(letters) <= 12 else [])), 25 * across)
    figure.supxlabel(names, fontsize=8, color="0.35")
    tall = min(max(heights, default=1.0), 1.4)
    figure.set_size_inches(2.1 * across, 0.6 + 0.15 * names.count("\n") + (0.45 + 2.0 * tall) * down)
    return axes.flatten()[: max(1, len(shown))]


def _orbits(result, ax, numbers, style):
    """The table with some of the orbits."""
    style = dict(style)
    cells = {(0, 0)}
    for number in numbers:
        steps = [point.get("step", (0, 0)) for point in result.json["orbits"][number]["points"]]
        cells |= {tuple(cell) for cell in numpy.cumsum([(0, 0), *steps], axis=0).tolist()}
    table(
        result.system, ax=ax, names=False, levels=False, directions=False, field=False, starts=0, cells=sorted(cells)
    )
    for number in numbers:
        path = _carom.path(result._outcome.system, 0, True, result.paths[number])
        family = result.json["orbits"][number]["family"]
        colour = colour_of(number, len(numbers)) if len(numbers) > 1 else COLOURS[0]
        usual = {"color": colour, "zorder": 2, "linestyle": "--" if family else "-"}
        ax.plot(path["x"], path["y"], **(usual | style))
        if style.pop("label", None):
            legend(ax)


@picture
def comparison(result, ax=None, of="error_state", **style):
    """Error against work: a line for each scheme, in colour by order; dashed: adaptive. Other
    errors by `of`. A dotted line is the wanted error, the grey band the uncertainty of the reference.
    style: keywords for the lines; a label precedes the names of the schemes."""
    style = style_of(style, markersize=3.5, linewidth=1)
    label = style.pop("label", None)
    ax = new_axes(ax, (6.6, 4.6))
    ax.set(xscale="log", yscale="log", xlabel="force evaluations")
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
        usual = {
            "color": colour, "linestyle": "--" if adaptive else "-", "label": f"{label}: {name}" if label else name,
            "marker": markers[used[colour] % len(markers)],
        }  # fmt: skip
        ax.plot(rows["force_evaluations"], rows[of], **(usual | style))
    if of == "error_state":
        ax.axhline(result.error, color="0.5", linewidth=0.8, linestyle=":", label="error wanted")
        low = result.reference.error
        ax.axhspan(low / 10, low, color="0.92", linewidth=0, label="error of the reference")
    ax.set_ylabel(of.replace("_", " of the ") if of.startswith("error_") else of)
    legend(ax, fontsize="x-small", loc="center left", bbox_to_anchor=(1, 0.5))
    title(ax, result.system)
    return ax


@picture
def equilibria(found, ax=None, most=4, **style):
    """The positions of the particles at the lowest equilibria, over the level lines of the potential, each in
    its own picture; with `ax` the lowest one. style: keywords for the dots, such as color and label."""
    style = style_of(style, color=COLOURS[0], marker="o", markersize=6, linestyle="", markeredgecolor="white")
    shown = found.equilibria[: most if ax is None else 1]
    if ax is not None:
        _equilibrium(found, ax, shown, style)
        title(ax, found.system)
        return ax
    many = max(1, len(shown))
    figure, axes = subplots(1, many, figsize=(max(3.6, 2.4 * many), 3.2), squeeze=False)
    axes = axes.flatten()
    for number, place in enumerate(axes):
        _equilibrium(found, place, shown[number : number + 1], style, shown)
        place.set(ylabel="" if number else "$y$", title="")
    for one, place in zip(shown, axes):
        place.set_title(f"{one.kind}\n$E$ = {one.energy:.8g}", fontsize=8)
    title_above(figure, found.system)
    return axes


def _equilibrium(found, ax, shown, style, others=()):
    """Particles at an equilibrium; the picture has room for those of the others, too."""
    if shown and not len(found.system.walls):
        places = numpy.concatenate([numpy.array(one.positions) for one in (*shown, *others)])
        reach = 1.3 * max(numpy.abs(places - places.mean(axis=0)).max(), 1e-300)
        x, y = places.mean(axis=0)
        ax.plot([x - reach, x + reach], [y - reach, y + reach], " ")
        ax.margins(0.0)
    table(found.system, ax=ax, names=False, directions=False, starts=0)
    for one in shown:
        ax.plot(*numpy.array(one.positions).T, **({"zorder": 5} | style))
    if shown and "label" in style:
        legend(ax)
