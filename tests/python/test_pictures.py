"""Pictures are made of everything; nothing is clipped."""

import matplotlib.pyplot as pyplot
import pytest

import carom


@pytest.fixture(autouse=True)
def close_figures():
    yield
    pyplot.close("all")


@pytest.mark.parametrize("name", carom.systems())
def test_every_system_is_drawn(name, tmp_path):
    figure = carom.system(name).plot().figure
    figure.savefig(tmp_path / "table.svg")


@pytest.mark.parametrize(
    "make",
    [
        lambda: carom.run("stadium", collisions=30),
        lambda: carom.run("ellipse-magnetic", collisions=30),
        lambda: carom.run("lorentz-triangular", collisions=30),
        lambda: carom.run("henon-heiles", t_max=20, sample=0.05),
        lambda: carom.run("wigner", t_max=5, sample=0.05),
        lambda: carom.escape("magnetic-square", trajectories=1000),
        lambda: carom.diffusion("lorentz-triangular", trajectories=500, t_max=30),
        lambda: carom.section("ellipse-magnetic", points=200, orbits=5),
        lambda: carom.section("henon-heiles", on="x=0", points=50, orbits=3, t_max=500),
    ],
)
def test_every_result_is_drawn(make, tmp_path):
    make().plot()
    pyplot.gcf().savefig(tmp_path / "result.png", dpi=60)
