"""Pictures of transport: mean square displacements, correlations of the velocity, free paths, returns."""

import numpy

from .axes import COLOURS, legend, new_axes, picture, plain, style_of, subplots, title, title_above, with_error


@picture
def diffusion(result, ax=None, **style):
    """The mean square displacement with its errors, and 4Dt where D is certain; style: that
    of the points, as color and label."""
    ax = new_axes(ax)
    points = result.msd
    seen = points[(points["t"] > 0) & (points["value"] > 0)]
    label = "MSD"
    if result.exponent is not None:
        label += f", exponent {with_error(result.exponent.value, result.exponent.stderr)}"
    ax.errorbar(
        seen["t"], seen["value"], yerr=numpy.nan_to_num(seen["stderr"]), fmt="o",
        **style_of(style, markersize=3, linewidth=1, color=COLOURS[0], label=label),
    )
    if result.D is not None and "note" not in result.json:
        ax.plot(
            seen["t"], 4 * result.D.value * seen["t"], color=COLOURS[1], linewidth=1,
            label=f"$4Dt$, $D$ = {with_error(result.D.value, result.D.stderr)}",
        )
    ax.set(xscale="log", yscale="log", xlabel="$t$", ylabel=r"$\langle|\mathbf{x}(t)-\mathbf{x}(0)|^2\rangle$")
    legend(ax, fontsize="small")
    title(ax, result.system)
    return ax


@picture
def correlation(result, ax=None, **style):
    """The velocity autocorrelation against t, and D(t) of Green and Kubo beside it."""
    if ax is not None:
        return _against_time(ax, result, result.correlation, r"$\langle\mathbf{v}(t)\cdot\mathbf{v}(0)\rangle$", style)
    figure, axes = subplots(1, 2, figsize=(8.0, 3.6))
    correlation(result, ax=axes[0], **style).set_title("")
    integral = r"$\frac{1}{2}\int_0^t\langle\mathbf{v}(t')\cdot\mathbf{v}(0)\rangle\,\mathrm{d}t'$"
    _against_time(axes[1], result, result.green_kubo, integral, style).set_title("")
    if result.D is not None and "note" not in result.json:
        D = result.D
        axes[1].axhspan(D.value - D.stderr, D.value + D.stderr, color=COLOURS[1], alpha=0.3, linewidth=0)
        axes[1].axhline(D.value, color=COLOURS[1], linewidth=1, label=f"$D$ of the MSD, {with_error(D.value, D.stderr)}")
        legend(axes[1], loc="upper left")
    title_above(figure, result.system)
    return axes


def _against_time(ax, result, points, label, style):
    """Points with errors against log t, and where they are zero."""
    seen = points[points["t"] > 0]
    ax.axhline(0.0, color="0.8", linewidth=0.6, zorder=0)
    style = style_of(style, markersize=3, linewidth=1, color=COLOURS[0])
    ax.errorbar(seen["t"], seen["value"], yerr=numpy.nan_to_num(seen["stderr"]), fmt="o", **style)
    if "label" in style:
        legend(ax)
    ax.set(xscale="log", xlabel="$t$", ylabel=label)
    title(ax, result.system)
    return ax


@picture
def free_paths(result, ax=None, **style):
    """The fraction of flights of a length or longer: between hits, and (hollow) from the start. style: keywords for
    the points; a label precedes both names."""
    ax = new_axes(ax)
    style = style_of(style, markersize=3, linewidth=1)
    before = f"{style.pop('label')}, " if "label" in style else ""
    paths = result.free_paths
    kinds = (("between hits", paths.between_hits), ("from the start", paths.at_start))
    for colour, (label, flights), hollow in zip(COLOURS, kinds, ({}, {"markerfacecolor": "white"})):
        seen = flights.bins[(flights.bins["from"] > 0) & (flights.bins["longer"] > 0)]
        ax.errorbar(
            seen["from"], seen["longer"], yerr=seen["longer_stderr"], fmt="o",
            **({"color": colour, "label": before + label} | hollow | style),
        )
    ax.set(xscale="log", yscale="log")
    # What the corridors say of long flights from uniform starts: t P(no hit until t) at speed 1.
    if "flight_tail" in result.json:
        left, right = ax.get_xlim()
        ax.autoscale(False)
        for colour, power, c in (
            (COLOURS[0], 2, result.flight_tail * paths.mean.value), (COLOURS[1], 1, result.flight_tail)
        ):
            lengths = [max(left, 3 * paths.mean.value), right]
            ax.plot(
                lengths, [c / one**power for one in lengths], color=colour, linewidth=1,
                label=rf"{with_error(c, None)} / $\ell{'^2' if power == 2 else ''}$, from the corridors",
            )
    ax.set(xlabel=r"$\ell$", ylabel=r"share of flights of $\ell$ or longer")
    legend(ax, fontsize="small")
    title(ax, result.system)
    return ax


@picture
def returns(result, ax=None, **style):
    """The fraction of excursions from the wall that last t or longer."""
    ax = new_axes(ax)
    seen = result.return_times[(result.return_times["from"] > 0) & (result.return_times["longer"] > 0)]
    ax.errorbar(
        seen["from"], seen["longer"], yerr=seen["longer_stderr"], fmt="o",
        **style_of(style, markersize=3, linewidth=1, color=COLOURS[0]),
    )
    if "label" in style:
        legend(ax)
    label = f"share of returns to {plain(result.wall)} after $t$ or more"
    ax.set(xscale="log", yscale="log", xlabel="$t$", ylabel=label)
    title(ax, result.system)
    return ax
