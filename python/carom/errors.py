"""Errors in the input."""

import os
from typing import NamedTuple

from . import _carom


def printable(text, lines=False):
    """The text with a visible name in place of each character that a terminal or XML takes for a
    command; `lines`: ends of lines stay."""
    return _carom.printable(text.encode("utf-8", "surrogatepass"), lines)


def text_of(thing, key):
    """What is given as text, if it is text that can be written."""
    thing = thing.tolist() if hasattr(thing, "tolist") else thing  # NumPy's strings
    if not isinstance(thing, str):
        raise InputError(f"'{key}' cannot be {thing!r}", ("", 0, 0, key), "text")
    try:
        thing.encode()
    except UnicodeEncodeError:
        raise InputError(f"'{key}' has halves of characters: {thing!a}", ("", 0, 0, key), "text in Unicode") from None
    return thing


def path_of(path):
    """The name of a file, as text."""
    try:
        text = os.fsdecode(path)
    except TypeError:
        raise InputError(f"{path!r} is not the name of a file", ("", 0, 0, "path"), "text, or a pathlib.Path") from None
    if "\0" in text_of(text, "path"):
        raise InputError(f"{path!r} is not the name of a file", ("", 0, 0, "path"), "a name without a zero")
    return text


def nearest(word, names):
    """The name that was meant, "" if none is near: one that only differs in its case, or the shortest that begins so,
    or one that is near by its letters."""
    names, low = list(names), word.lower()
    same = [name for name in names if name.lower() == low]
    begin = [name for name in names if name.lower().startswith(low)]
    if same or len(begin) == 1 or (begin and len(word) > 2):
        return min(same or begin, key=len)
    return _carom.nearest_name(word, names)


class Place(NamedTuple):
    """Where a value was written; line and column count from 1, 0: unknown."""

    file: str
    line: int
    column: int
    key: str


class InputError(ValueError):
    """Bad input: where it stands, what was expected, and the nearest name that is valid.

    Attributes: place (Place), expected (str), nearest (str, "" if none is near).
    """

    def __init__(self, message, place=("", 0, 0, ""), expected="", nearest=""):
        super().__init__(printable(message))
        self.place = Place(*place)
        self.expected = expected
        self.nearest = nearest

    def __reduce__(self):
        return InputError, (self.args[0], tuple(self.place), self.expected, self.nearest)
