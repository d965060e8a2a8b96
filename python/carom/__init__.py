"""Classical particles in two dimensions: exact billiards, fields, potentials, ensembles.

    import carom
    table = carom.stadium(half_length=1, radius=1).hole("bottom", center=1, width=0.2)
    result = carom.escape(table, t_max=100, trajectories=10**5)
    print(result)
    result.plot()

Every number is made by the same C++ as the program's `carom`, with the same digest.
"""

try:
    import numpy as _numpy  # noqa: F401: the compiled module fails without it, and does not say why
except ImportError as _error:
    raise ImportError("carom needs NumPy (Debian: python3-numpy; pip install numpy)") from _error

from . import _carom, plot
from .animation import animate
from .blocks import hits, trajectories
from .commands import (
    compare,
    diffusion,
    escape,
    lyapunov,
    open,
    orbits,
    relax,
    returns,
    run,
    schemes,
    section,
    table,
    validate,
)
from .errors import InputError, Place
from .estimates import Estimate
from .records import Record
from .return_times import Returns
from .results import (
    Certified,
    Comparison,
    Diffusion,
    Equilibria,
    Escape,
    Exact,
    Lyapunov,
    Orbits,
    Result,
    Run,
    Section,
    Splitting,
    Table,
    Validation,
)
from .shapes import (
    annulus,
    cardioid,
    circle,
    discs,
    egg,
    ellipse,
    flower,
    implicit,
    lemon,
    limacon,
    lorentz,
    mushroom,
    parametric,
    path,
    plane,
    polar,
    polygon,
    rectangle,
    regular,
    robnik,
    sinai,
    spline,
    stadium,
    superellipse,
    svg,
    triangle,
)
from .sweep import Sweep
from .system import System, load, system, systems

__version__: str = _carom.version
#: Names of fates: `carom.fates[row["fate"]]`.
fates: list[str] = list(_carom.fates)
