"""Axes, titles, colours and texts of pictures."""

import functools
import textwrap
from typing import Any, Callable, TypeVar, cast

import numpy

from .errors import InputError, nearest, printable
from .estimates import rounded

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
    "axes.formatter.use_mathtext": True,
}  # fmt: skip

#: How pictures write columns of results.
SYMBOLS = {
    "v_parallel": r"$v_\parallel$", "vx": "$v_x$", "vy": "$v_y$", "lambda": "λ", "rate": "κ", "survival": "$p(T)$",
    "field.B": "$B$", "run.t_max": "$T$", "particles.energy": "$E$", "particles.count": "$N$",
    "sali": "SALI", "time": "time of the end",
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
    return colour_map()(number / (many - 1))


def colour_map():
    """For lines and dots: without the light end, which is hard to see on white."""
    from matplotlib.colors import ListedColormap

    return ListedColormap(pyplot().get_cmap("viridis")(numpy.linspace(0.0, 0.92, 256)))


def colour_bar(ax, drawn, name, **keywords):
    """What colours say, in a bar as high as the picture; what stands beside the picture steps aside."""
    from matplotlib.offsetbox import AnchoredOffsetbox

    for one in ax.artists:
        if isinstance(one, AnchoredOffsetbox):
            one.set_bbox_to_anchor((1.17, 0.0), ax.transAxes)
    ax.figure.colorbar(drawn, cax=ax.inset_axes([1.03, 0.0, 0.035, 1.0]), label=symbol(name), **keywords)


def scale_of(values):
    """Logarithmic for numbers above zero that differ by more than twenty times, else linear."""
    known = values[values == values]
    return "log" if len(known) and known.min() > 0 and known.max() > 20 * known.min() else "linear"


def plain(text):
    """A title or a name as pictures show it: without control characters, and never as a formula."""
    return printable(text).replace("$", r"\$")


def symbol(name):
    """A column or a key as the field writes it; others by their words, "hole width"."""
    if "." in name and name not in SYMBOLS:
        name = " ".join(name.replace("[0]", "").replace("parameters.", "").split(".")[1:]).replace("_", " ")
    return SYMBOLS.get(name) or (f"${name}$" if len(name) == 1 else plain(name))


def with_error(value, error, digits=3):
    """A value with its error to two digits, both rounded at the same place, 0.34285(54); a value without an
    error to so many digits."""
    known = error and numpy.isfinite(error)
    text, power = rounded(value, error) if known else (f"{value:.{digits}g}".partition("e")[::2])
    return text.replace("-", "−") + (f"·10$^{{{int(power)}}}$" if power else "")


def title_of(system, width=56):
    """The title of a system; below it what the command line or a call changed in it. Without a title: nothing."""
    words, _, changes = plain(system.title).partition(", with ")
    return "\n".join(textwrap.fill(line, width) for line in (words, changes and f"with {changes}") if line)


def title(ax, system):
    ax.set_title(title_of(system), fontsize=9)


def title_above(figure, system):
    """The title of several pictures."""
    figure.get_layout_engine().set(h_pad=0.08)
    figure.suptitle(title_of(system, max(24, int(11 * figure.get_size_inches()[0]))), fontsize=9)


Drawing = TypeVar("Drawing", bound=Callable[..., Any])


def picture(function: Drawing) -> Drawing:
    """A function that draws what it is given, in Carom's look where it makes the axes; of other things it says
    which pictures there are."""

    @functools.wraps(function)
    def draw(thing, *arguments, **keywords):
        try:
            with pyplot().rc_context({} if arguments or keywords.get("ax") is not None else STYLE):
                return function(thing, *arguments, **keywords)
        except AttributeError as error:
            there = getattr(thing, "_pictures", dict)()
            name = function.__name__
            if name in there or function in there.values() or draw in there.values():
                raise
            of = f"carom.{type(thing).__name__}" if hasattr(thing, "_pictures") else printable(repr(thing))
            expected = ", ".join(f"carom.plot.{one}" for one in there) or "a result or a system"
            raise InputError(
                f"carom.plot.{name} cannot draw {of}; what can be drawn: {expected}", ("", 0, 0, name), expected
            ) from error

    return cast(Drawing, draw)


def style_of(keywords, **usual):
    """Keywords of a line for matplotlib, under any of its names for them; `usual` where none are given."""
    from matplotlib.cbook import normalize_kwargs
    from matplotlib.lines import Line2D

    for key in keywords:
        if not hasattr(Line2D, f"set_{key}"):
            known = ("color", "label", "linewidth", "linestyle", "alpha", "marker", "markersize", "zorder")
            near = nearest(key, known)
            hint = f"; did you mean '{near}'?" if near else ""
            raise InputError(f"pictures have no keyword '{key}'{hint}", ("", 0, 0, key), ", ".join(known), near)
    return usual | normalize_kwargs(keywords, Line2D)


def dots_of(style):
    """The style of a line for `scatter`."""
    names = {"color": "color", "label": "label", "alpha": "alpha", "zorder": "zorder", "marker": "marker"}
    dots = {names[key]: one for key, one in style.items() if key in names}
    dots["linewidths"] = style.get("linewidth", 0)
    return dots | ({"s": style["markersize"] ** 2} if "markersize" in style else {})


def legend(ax, **keywords):
    """What lines and points mean: points with errors first, each name once."""
    from matplotlib.container import Container

    handles, labels = ax.get_legend_handles_labels()
    entries = dict(zip(labels, handles))
    first = sorted(entries, key=lambda name: not isinstance(entries[name], Container))
    ax.legend([entries[name] for name in first], first, **({"frameon": False, "fontsize": 8} | keywords))
