"""How far a computation is: in a notebook, on a terminal, or told to a function."""

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
    """Below the cell of a notebook, whose stop button ends the computation as Ctrl-C does."""

    def __init__(self, display, html):
        super().__init__()
        self.display, self.html, self.handle = display, html, None

    def show(self, share, text):
        self.draw(f'<progress max="1" value="{share:.4f}" style="width: 20em"></progress> <code>{text}</code>')

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


def shown(progress, function, *arguments):
    """Calls a function of the compiled module with its progress shown."""
    show = progress_of(progress)
    try:
        return function(*arguments, progress=show)
    finally:
        if hasattr(show, "close"):
            show.close()
