"""What can be wrong with what is asked for."""

from typing import NamedTuple


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
        super().__init__(message)
        self.place = Place(*place)
        self.expected = expected
        self.nearest = nearest

    def __reduce__(self):
        return InputError, (self.args[0], tuple(self.place), self.expected, self.nearest)
