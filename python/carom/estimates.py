"""Values with their errors."""

import math
from typing import Optional


def rounded(value, error):
    """A value with its error to two digits, both rounded at the same place, and the power of ten that they
    are multiplied by: ("0.34285(54)", 0)."""
    if not error or not math.isfinite(error) or not math.isfinite(value):
        return f"{value:.5g}", 0
    digits = 1 - math.floor(math.log10(error))
    if round(error, digits) >= 10 ** (2 - digits):
        digits -= 1
    if digits < 0 or digits > 8:
        power = math.floor(math.log10(max(abs(value), error)))
        return rounded(value / 10.0**power, error / 10.0**power)[0], power
    last = round(error * 10**digits)
    return f"{value:.{digits}f}({last if digits else round(error)})", 0


class Estimate(float):
    """A value with its standard error: a float that is printed as 0.34285(54), the error being that of the
    last digits. `value, error = estimate` takes it apart; other keys of the JSON are attributes, too.

    value, error: in the unit of the value; error is None where it is not known. stderr: the error.
    """

    value: float
    error: Optional[float]
    stderr: Optional[float]

    def __new__(cls, value, error=None, **more):
        made = super().__new__(cls, value)
        made.__dict__.update(value=value, stderr=error, error=error, **more)
        return made

    def __iter__(self):
        return iter((self.value, self.error))

    def __getitem__(self, key):
        return self.__dict__[key]

    def keys(self):
        """The names."""
        return [key for key in self.__dict__ if key != "error"]

    def __repr__(self):
        text, power = rounded(self.value, self.error)
        return f"{text}e{power}" if power else text

    __str__ = __repr__

    def __format__(self, spec):
        return format(float(self), spec) if spec else repr(self)

    def __reduce__(self):
        more = {key: one for key, one in self.__dict__.items() if key not in ("value", "error", "stderr")}
        return _unpickled, (self.value, self.error, more)


def _unpickled(value, error, more):
    return Estimate(value, error, **more)
