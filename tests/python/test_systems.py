"""Tables and systems from Python, and what is said of bad ones."""

import decimal
import fractions
import pathlib
import pickle

import numpy
import pytest

import carom

DRAWINGS = pathlib.Path(__file__).parents[1] / "drawings"


def test_a_table_is_built_with_holes_and_obstacles():
    table = (
        carom.stadium(half_length=1, radius=1)
        .hole("bottom", center=0.5, width=0.2, name="exit")
        .obstacle("circle", center=[0, 0], radius="1/5")
    )
    assert table.walls == ["bottom", "right", "top", "left", "obstacle_1"]
    assert table.holes == ["exit"]
    assert "1/5" in table.to_toml()
    assert table._repr_svg_().startswith("<?xml")


def test_obstacles_are_curves_by_the_names_of_tables():
    around = numpy.linspace(0, 2 * numpy.pi, 24, endpoint=False)
    points = 4 + 0.8 * numpy.stack([numpy.cos(around), numpy.sin(around)], axis=1)
    room = carom.rectangle(8, 8)
    for table in (
        room.obstacle("polar", name="o", center=(4, 4), radius="0.8"),
        room.obstacle("parametric", name="o", x="4 + 0.8*cos(t)", y="4 + 0.8*sin(t)", start=0, end="2*pi"),
        room.obstacle("spline", name="o", points=points),
        room.obstacle("spline", name="o", points=points[::-1]),
        room.obstacle("path", name="o", start=(4.8, 4), pieces=[
            {"arc_via": (4, 4.8), "arc_to": (3.2, 4)}, {"arc_via": (4, 3.2), "arc_to": (4.8, 4)}]),
    ):  # fmt: skip
        assert table.walls[4].startswith("o_")
        assert table.area == pytest.approx(64 - 0.64 * numpy.pi, rel=1e-4)


@pytest.mark.parametrize("name", [path.stem for path in DRAWINGS.glob("*.svg")])
def test_a_drawing_gives_the_orbits_of_the_same_table_in_toml(name, tmp_path):
    drawn = carom.svg(DRAWINGS / f"{name}.svg", scale="1/10")
    (tmp_path / "same.toml").write_text(drawn.to_toml())
    same = carom.load(tmp_path / "same.toml")
    assert "svg" not in drawn.to_toml()
    one, other = (carom.run(table, collisions=200, t_max=1e9) for table in (drawn, same))
    assert len(one.hits) == 200
    for name in one.hits.dtype.names:  # bytes between them may be anything
        assert one.hits[name].tobytes() == other.hits[name].tobytes()


@pytest.mark.parametrize(
    "make",
    [
        carom.rectangle,
        carom.circle,
        carom.stadium,
        carom.sinai,
        carom.lorentz,
        lambda: carom.polygon([(0, 0), (2, 0), (2, 1), (0, 1)]),
        lambda: carom.triangle([(0, 0), (1, 0), (0, 1)]),
        lambda: carom.regular(5),
        lambda: carom.ellipse(2, 1),
        lambda: carom.annulus(2, 1, offset=0.5),
        lambda: carom.mushroom(1, 0.5, 1),
        lambda: carom.lemon(1, 1),
        lambda: carom.discs([(0, 0), (6, 0)], radius=1),
        carom.cardioid,
        lambda: carom.implicit("x^4 + y^4 - 1"),
        carom.limacon,
        carom.flower,
        carom.superellipse,
        carom.robnik,
        carom.egg,
        lambda: carom.polar("1 + 0.3*cos(3*phi)"),
        lambda: carom.parametric("2*cos(t)", "sin(t)"),
        lambda: carom.spline([(0, 0), (3, -1), (4, 1), (2, 2)]),
        lambda: carom.svg(DRAWINGS / "inkscape.svg"),
    ],
)
def test_every_shape_has_a_length(make):
    assert make().perimeter > 0


def test_numbers_are_those_that_are_written():
    third = carom.rectangle(width=fractions.Fraction(1, 3), height=decimal.Decimal("0.1"))
    assert '"1/3"' in third.to_toml()
    assert third.area == pytest.approx(1 / 30, rel=1e-15)
    assert carom.table(carom.rectangle(10**20, 1)).area == 1e20  # TOML has no such integer


def test_a_changed_system_is_another_one():
    square = carom.system("magnetic-square")
    assert "B" in square.with_(B=0.5).to_toml()
    assert square.to_toml() == carom.system("magnetic-square").to_toml()


def test_the_file_of_a_system_gives_the_system(tmp_path):
    file = tmp_path / "my.toml"
    table = carom.mushroom(1, 0.5, 1).hole("cap", center=1, width=0.1).with_(t_max=10)
    file.write_text(table.to_toml(), encoding="utf-8")
    assert carom.load(file).to_toml() == table.to_toml()


def test_holes_are_cut_into_the_table_as_it_is_then():
    shut = carom.stadium().hole("top", center=1, width="1/5", name="a").with_(engine="steps", t_max=7).closed()
    opened = shut.hole("bottom", center=1, width=0.1, name="b").hole("top", center=1, width=0.1, name="c")
    assert opened.holes == ["b", "c"] and shut.holes == []
    assert carom.run(opened, integrator={"step": 0.01}, t_max=1).engine == "steps"
    assert "t_max = 7" in opened.to_toml()
    disc = carom.stadium().with_(table={"shape": "circle", "radius": 1})
    assert disc.hole("circle", center=1, width=0.1).obstacle("circle", center=(0, 0), radius=0.1).holes == ["hole_1"]


def test_errors_say_where_and_what():
    with pytest.raises(carom.InputError) as error:
        carom.escape("magnetic-square", trajectoriess=10)
    assert error.value.nearest == "trajectories"
    with pytest.raises(carom.InputError) as error:
        carom.system("stadum")
    assert error.value.nearest == "stadium"
    with pytest.raises(carom.InputError) as error:
        carom.rectangle(width=-1)
    assert error.value.place == ("", 0, 0, "width")
    with pytest.raises(carom.InputError) as error:
        carom.stadium().hole("botom", center=0, width=0.1)
    assert error.value.nearest == "bottom"
    assert pickle.loads(pickle.dumps(error.value)).nearest == "bottom"


def test_systems_are_pickled():
    table = carom.stadium().hole("top", center=1, width=0.1)
    assert pickle.loads(pickle.dumps(table)).to_toml() == table.to_toml()


def test_regions_and_laws_of_walls():
    box = carom.rectangle(4, 3).obstacle("circle", center=(2.1, 1.4), radius=0.7, name="disc")
    glass = box.region("disc", index=1.5, reflection="s").with_(title="Glass")
    assert glass.title == "Glass" and glass.walls[-2:] == ["disc", "disc.inside"]
    run = carom.run(glass, position=(0.5, 1.4), velocity=(1, 0), collisions=2)
    assert {"disc", "disc.inside"} & {glass.walls[hit["wall"]] for hit in run.hits}
    field = box.region("disc", B=4)
    path = carom.run(field, position=(2.1, 1.4), velocity=(0.5, 0), collisions=1, t_max=50).path()
    assert numpy.hypot(path["x"] - 2.1, path["y"] - 1.4 + 0.125).round(9).tolist()[:2] == [0.125, 0.125]
    rough = box.wall("mixed", wall="left", specularity=0.5).wall("diffuse", wall="disc")
    assert "specularity = 0.5" in rough.to_toml()
    closed = carom.run(glass.wall("specular", wall="disc"), position=(0.5, 1.4), velocity=(1, 0), collisions=1)
    assert closed.hits["vx"][0] < -0.999
    with pytest.raises(carom.InputError, match="particles pass wall 'disc'"):
        glass.hole("disc", center=1, width=0.5)
    with pytest.raises(carom.InputError, match="particles enter regions"):
        carom.lyapunov(glass)


def test_a_table_is_divided_by_an_edge_from_wall_to_wall():
    whole = carom.polygon([(0, 0), (2, 0), (4, 0), (4, 2), (2, 2), (0, 2)])
    halves = whole.region(start=(2, 2), pieces=[{"line_to": (2, 0), "name": "step"}], potential=0.3)
    assert {"step", "step.inside"} <= set(halves.walls) and halves.area == whole.area
    run = carom.run(halves, position=(1, 1), velocity=(1, 0), collisions=2)
    assert run.hits["x"].tolist() == [2, 4] and abs(run.hits["vx"][0] - 0.4**0.5) < 1e-15
    assert halves.plot() is not None


def test_the_page_is_shown_with_the_system(monkeypatch, tmp_path):
    import base64
    import zlib

    stadium = carom.stadium(half_length=1, radius=1)
    packed = carom.page.fragment(stadium).removeprefix("#toml=")
    packed += "=" * (-len(packed) % 4)
    assert zlib.decompress(base64.urlsafe_b64decode(packed), wbits=-15).decode() == stadium.to_toml()
    page = tmp_path / "carom.html"
    page.write_text("<html><head></head></html>")
    monkeypatch.setattr(carom.page, "_file", lambda: page)
    monkeypatch.setattr(carom.page.webbrowser, "open", lambda address: True)
    assert stadium.show() == page.as_uri() + carom.page.fragment(stadium)
