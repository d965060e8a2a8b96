"""Progress of a computation: in a notebook, on a terminal, or passed to a function."""

import base64
import io
import sys
import time
from typing import Callable, Union

from .errors import InputError

Progress = Union[bool, None, Callable[[float, int], object]]


class _Shown:
    """Shows the share that is done, and of what how much, at most some times a second."""

    def __init__(self):
        self.begin = self.last = time.monotonic()
        self.shown = False

    def __call__(self, share, done):
        now = time.monotonic()
        if now - self.last < 0.5:
            return
        self.last = now
        left = (now - self.begin) * (1 - share) / share if share > 0 else None
        text = f"{100 * share:5.1f} %  {done} done" + (f", {left:.0f} s left" if left is not None else "")
        self.show(share, text)
        self.shown = True

    def close(self):
        if self.shown:
            self.hide()


class _Line(_Shown):
    """On one line of a terminal."""

    def show(self, share, text):
        sys.stderr.write(f"\r\033[K{text} ")
        sys.stderr.flush()

    def hide(self):
        sys.stderr.write("\r\033[K")


class _Bar(_Shown):
    """Below the cell of a notebook, whose stop button ends the computation as Ctrl-C does, with the
    picture of an ensemble's result so far."""

    def __init__(self, display, html):
        super().__init__()
        self.display, self.html, self.handle = display, html, None
        self.result_of = None  # makes a result of what the compiled module gives
        self.picture, self.next_picture = "", self.begin

    def show(self, share, text):
        bar = f'<progress max="1" value="{share:.4f}" style="width: 20em"></progress> <code>{text}</code>'
        self.draw(bar + self.picture)

    def so_far(self, outcome):
        """Called some times a second at most. Drawing takes a tenth of the time."""
        begin = time.monotonic()
        if self.result_of is None or begin < self.next_picture:
            return
        try:
            self.picture = _image(self.result_of(outcome))
        except (InputError, ImportError):  # it has nothing to draw yet, or there is no matplotlib
            self.picture = ""
        end = time.monotonic()
        self.next_picture = end + 9 * (end - begin)

    def hide(self):
        self.draw("")

    def draw(self, text):
        if self.handle is None:
            self.handle = self.display(self.html(text), display_id=True)
        else:
            self.handle.update(self.html(text))


class _Tqdm:
    """On a terminal by tqdm."""

    def __init__(self, tqdm):
        self.bar = tqdm(total=1.0, bar_format="{percentage:3.0f} %|{bar}| {elapsed}<{remaining}")

    def __call__(self, share, done):
        self.bar.update(share - self.bar.n)

    def close(self):
        self.bar.close()


def _image(result):
    """The first picture of a result, as HTML."""
    from .axes import pyplot

    axes = result.plot()
    figure = (axes if hasattr(axes, "figure") else axes.flat[0]).figure
    file = io.BytesIO()
    figure.savefig(file, format="png")
    pyplot().close(figure)  # else the notebook shows it, too
    return f'<br><img src="data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}">'


def _in_notebook():
    """Does IPython run this for a notebook?"""
    ipython = sys.modules.get("IPython")
    return hasattr(ipython.get_ipython() if ipython else None, "kernel")


def progress_of(progress):
    """What is called with the share and the number done, or None."""
    if callable(progress):
        return progress
    if not isinstance(progress, (bool, type(None))):
        raise InputError(
            f"'progress' is {progress!r}", ("", 0, 0, "progress"), "True, False, None, or a function of (share, done)"
        )
    if progress is not False and _in_notebook():
        from IPython.display import HTML, display

        return _Bar(display, HTML)
    if not (sys.stderr.isatty() if progress is None else progress):
        return None
    try:
        from tqdm import tqdm
    except ImportError:
        return _Line()
    return _Tqdm(tqdm)


def shown(progress, function, *arguments, result_of=None):
    """Calls a function of the compiled module with its progress shown. result_of: makes a result of
    what it gives."""
    show = progress_of(progress)
    if isinstance(show, _Bar):
        show.result_of = result_of
    try:
        return function(*arguments, progress=show)
    finally:
        if hasattr(show, "close"):
            show.close()
