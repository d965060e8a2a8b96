"""Every picture of every result: what it returns, and matplotlib's keywords."""

import matplotlib.colors
import matplotlib.pyplot as pyplot
import numpy
import pytest
from matplotlib.axes import Axes

import carom

GRID = {"from": "-0.9", "to": "0.9", "count": 4}
STARTS = {"kind": "birkhoff", "wall": "circle", "s": {"from": 0, "to": 5, "count": 3}, "v_parallel": GRID}
FEW = {"trajectories": 300, "t_max": 20}

MAKERS = {
    "System": lambda: carom.system("mushroom"),
    "Table": lambda: carom.table("stadium"),
    "Run": lambda: carom.run("stadium", collisions=30),
    "Run, forces": lambda: carom.run("wigner", t_max=1, sample=0.1),
    "Escape": lambda: carom.escape("stadium", per_trajectory=True, **FEW),
    "Splitting": lambda: carom.escape("three-disc", splitting=[2, 4, 6], population=200, repetitions=4),
    "Splitting, hits": lambda: carom.escape("three-disc", splitting="hits:lin:0:6:7", population=100, repetitions=4),
    "Diffusion": lambda: carom.diffusion("lorentz-square", free_paths=True, **FEW),
    "Lyapunov": lambda: carom.lyapunov("sinai", per_trajectory=True, **FEW),
    "Lyapunov, grid": lambda: carom.lyapunov(
        carom.circle().obstacle("circle", center=[0.3, 0], radius=0.2), initial=STARTS, trajectories=12, t_max=50,
        per_trajectory=True,
    ),
    "Lyapunov, spectrum": lambda: carom.lyapunov("wigner", trajectories=2, t_max=5, spectrum=True),
    "Returns": lambda: carom.returns("sinai", on="wall:disc", **FEW),
    "Section": lambda: carom.section("ellipse-magnetic", points=50, orbits=3),
    "Orbits": lambda: carom.orbits("three-disc", hits=3),
    "Equilibria": lambda: carom.relax("wigner", starts=5),
    "Comparison": lambda: carom.compare("henon-heiles", schemes="velocity-verlet,forest-ruth-4", t_max=5),
    "Validation": lambda: carom.validate(scale=0.0001),
    "Sweep": lambda: carom.escape("stadium", sweep={"field.B": [0, 0.5, 1]}, **FEW),
    "Sweep, plane": lambda: carom.escape("stadium", sweep={"field.B": [0, 1], "run.seed": [1, 2, 3]}, **FEW),
}  # fmt: skip
RED = matplotlib.colors.to_rgba("red")


@pytest.fixture(scope="module", params=MAKERS)
def result(request):
    return MAKERS[request.param]()


def colours_of(ax):
    """Of all that is drawn."""
    found = [line.get_color() for line in ax.get_lines()]
    for one in (*ax.collections, *ax.patches):
        found += [*numpy.atleast_2d(one.get_facecolor()), *numpy.atleast_2d(one.get_edgecolor())]
    return {matplotlib.colors.to_rgba(colour)[:3] for colour in found if len(colour)}


def test_all_classes_are_drawn():
    classes = {name.split(",")[0] for name in MAKERS}
    with_pictures = {
        name for name in vars(carom)
        if isinstance(getattr(carom, name), type) and hasattr(getattr(carom, name), "_pictures")
    }  # fmt: skip
    assert classes == with_pictures - {"Result", "Certified"}


def test_a_picture_is_axes_or_an_array_of_them(result):
    assert carom.plot.pictures(result)
    for name in carom.plot.pictures(result):
        drawn = carom.plot.result(result, what=name)
        assert isinstance(drawn, Axes) or (drawn.ndim == 1 and all(isinstance(one, Axes) for one in drawn)), name
        assert drawn.figure.axes
        pyplot.close("all")
    drawn = result.plot()
    assert drawn.figure.axes
    pyplot.close("all")


def test_pictures_take_the_keywords_of_matplotlib(result):
    for name in carom.plot.pictures(result):
        ax = pyplot.figure().gca()
        drawn = carom.plot.result(result, ax=ax, what=name, color="red", label="mine", lw=2, alpha=0.5)
        assert drawn is ax, name
        of_a_plane = ax.collections and ax.collections[0].get_array() is not None  # colours say the values
        assert of_a_plane or RED[:3] in colours_of(ax), name
        labels = ax.get_legend_handles_labels()[1]
        assert of_a_plane or (ax.get_legend() and any(label.startswith("mine") for label in labels)), name
        assert labels.count("mine") <= 1, name
        ax.figure.canvas.draw()
        with pytest.raises(carom.InputError, match="no keyword 'colr'; did you mean 'color'"):
            carom.plot.result(result, what=name, colr="red")
        pyplot.close("all")


def test_other_things_are_not_drawn_and_the_pictures_that_there_are_are_named():
    run = carom.run("stadium", collisions=3)
    with pytest.raises(carom.InputError, match=r"survival cannot draw carom.Run; .* carom.plot.orbit"):
        carom.plot.survival(run)
    with pytest.raises(carom.InputError, match=r"orbit cannot draw carom.System; .* carom.plot.table"):
        carom.plot.orbit(carom.circle())
    with pytest.raises(carom.InputError, match="energy cannot draw 5"):
        carom.plot.energy(5)
