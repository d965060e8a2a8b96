"""Axes, titles, colours and texts of pictures."""

import math
import textwrap

import numpy

from .errors import printable

#: Seven colours that can be told apart by people who see few of them (Okabe and Ito).
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")

#: The look of all pictures: `matplotlib.pyplot.style.use(carom.plot.STYLE)` gives it to your own.
STYLE = {
    "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.7,
    "axes.labelsize": 9, "axes.titlesize": 9, "axes.titlepad": 8,
    "xtick.labelsize": 8, "ytick.labelsize": 8, "xtick.major.width": 0.7, "ytick.major.width": 0.7,
    "xtick.minor.width": 0.5, "ytick.minor.width": 0.5, "xtick.major.size": 3, "ytick.major.size": 3,
    "xtick.minor.size": 1.8, "ytick.minor.size": 1.8,
    "legend.frameon": False, "legend.fontsize": 8, "figure.titlesize": 9, "lines.linewidth": 1.0,
}  # fmt: skip

#: How pictures write columns of results.
SYMBOLS = {
    "v_parallel": r"$v_\parallel$", "vx": r"$v_x$", "vy": r"$v_y$", "lambda": "λ", "rate": "κ", "hits": "hits",
    "field.B": "B", "run.t_max": "T", "run.window": "window", "particles.energy": "E", "particles.count": "N",
}  # fmt: skip


def pyplot():
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib (Debian: python3-matplotlib)") from error
    return pyplot


class Panels(numpy.ndarray):
    """The axes of several pictures in one figure."""

    @property
    def figure(self):
        return self.flat[0].figure


def subplots(*shape, **keywords):
    """Figure and axes in Carom's look; several axes are Panels."""
    with pyplot().rc_context(STYLE):
        figure, axes = pyplot().subplots(*shape, layout="constrained", **keywords)
    return figure, axes.view(Panels) if isinstance(axes, numpy.ndarray) else axes


def new_axes(ax, size=(5.0, 4.2)):
    return ax if ax is not None else subplots(figsize=size)[1]


def colour_of(number, many):
    """The colour of one of so many things: a list of seven, or a scale if there are more."""
    if many <= len(COLOURS):
        return COLOURS[number % len(COLOURS)]
    return pyplot().get_cmap("viridis")(0.92 * number / (many - 1))


def scale_of(values):
    """Logarithmic for numbers above zero that differ by more than twenty times, else linear."""
    known = values[values == values]
    return "log" if len(known) and known.min() > 0 and known.max() > 20 * known.min() else "linear"


def plain(text):
    """A title or a name as pictures show it: without control characters, and never as a formula."""
    return printable(text).replace("$", r"\$")


def symbol(name):
    """A column or a key as the field writes it."""
    return SYMBOLS.get(name, plain(name))


def with_error(value, error):
    """A value with its error to two digits, both rounded at the same place: 0.34285(54)."""
    if not error or not math.isfinite(error):
        return f"{value:.5g}"
    digits = 1 - math.floor(math.log10(error))
    if round(error, digits) >= 10 ** (2 - digits):
        digits -= 1
    if digits < 0 or digits > 8:
        power = math.floor(math.log10(max(abs(value), error)))
        return rf"{with_error(value / 10.0**power, error / 10.0**power)}·10$^{{{power}}}$"
    last = round(error * 10**digits)
    return f"{value:.{digits}f}({last if digits else round(error)})"


def title_of(system, width=56):
    """The title of a system; below it what the command line or a call changed in it."""
    words, _, changes = plain(system.title or system.name).partition(", with ")
    return "\n".join(textwrap.fill(line, width) for line in (words, changes and f"with {changes}") if line)


def title(ax, system):
    ax.set_title(title_of(system), fontsize=9)


def title_above(figure, system):
    """The title of several pictures."""
    figure.suptitle(title_of(system, max(24, int(11 * figure.get_size_inches()[0]))), fontsize=9)


def style_of(keywords, **usual):
    """Keywords of a line for matplotlib, under any of its names for them; `usual` where none are given."""
    from matplotlib.cbook import normalize_kwargs
    from matplotlib.lines import Line2D

    return usual | normalize_kwargs(keywords, Line2D)


def legend(ax, *entries, **keywords):
    ax.legend(*entries, **({"frameon": False, "fontsize": 8} | keywords))
