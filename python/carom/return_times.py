"""Return times to a wall."""

from . import plot
from ._carom import counted
from .stored import Result


class Returns(Result, archive="returns"):
    """Return times to a wall.

    excursions; half (time): half of the run, in which they begin; mean_time (value, stderr: time) and
    mean_hits, expected_time and expected_hits by Kac's lemma (None where it does not apply), tail and
    tail_hits (from, to, exponent: value, stderr; None: too few long excursions). Arrays:

    return_times  (number of bins,): from, to (time), count, density (1/time), longer (share) …
    return_hits   (number of bins,): from, to, count, longer: by hits, the last one included
    """

    def _pictures(self):
        return {"returns": plot.returns}

    def _summary(self):
        return f"{counted(self.excursions, 'excursion')} from {self.wall}, mean time {self.mean_time}"

    def _main(self):
        return self.return_times
