"""Axes, titles and colours of pictures."""

import textwrap

from .errors import printable

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")


def pyplot():
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("pictures need matplotlib (Debian: python3-matplotlib)") from error
    return pyplot


def new_axes(ax, size=(5.0, 4.2)):
    if ax is not None:
        return ax
    _, ax = pyplot().subplots(figsize=size, layout="constrained")
    return ax


def plain(text):
    """A title or a name as pictures show it: without control characters, and never as a formula."""
    return printable(text).replace("$", r"\$")


def title_of(system, width=56):
    return textwrap.fill(plain(system.title or system.name), width)


def title(ax, system):
    ax.set_title(title_of(system), fontsize="small")
