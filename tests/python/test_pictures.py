"""Pictures are made of everything; nothing is clipped."""

import shutil

import matplotlib.pyplot as pyplot
import numpy
import pytest

import carom
from carom.axes import symbol, with_error


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
        lambda: carom.orbits("three-disc", hits=4),
        lambda: carom.orbits("magnetic-square", hits=4, starts=500, tries=50),
        lambda: carom.section("henon-heiles", on="x=0", points=50, orbits=3, t_max=500),
    ],
)
def test_every_result_is_drawn(make, tmp_path):
    make().plot()
    pyplot.gcf().savefig(tmp_path / "result.png", dpi=60)


@pytest.mark.parametrize("name", carom.systems())
def test_names_cover_nothing_and_are_not_clipped(name):
    nothing_is_covered(carom.system(name).plot())


def test_a_hundred_names_are_not_written():
    comb = [(0, 0), (50, 0), *((50 - x, 1 + x % 2) for x in range(51))]
    ax = carom.polygon(comb).plot()
    assert len([one for one in ax.texts if one.get_text()]) == 0
    ring = carom.regular(12, radius=1)
    nothing_is_covered(ring.plot())
    small = carom.rectangle(10, 10)
    for k in range(8):
        small = small.obstacle("circle", center=[1 + 0.11 * k, 5], radius=0.05)
    nothing_is_covered(small.plot())


def nothing_is_covered(ax):
    figure = ax.figure
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    boxes = [t.get_window_extent(renderer) for t in ax.texts if t.get_text()]
    whole = figure.bbox
    for i, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[i + 1 :])
        assert box.x0 >= whole.x0 and box.x1 <= whole.x1 and box.y0 >= whole.y0 and box.y1 <= whole.y1
    for one in (ax.title, ax.xaxis.label, ax.yaxis.label):
        box = one.get_window_extent(renderer)
        assert box.x0 >= whole.x0 and box.x1 <= whole.x1 and box.y0 >= whole.y0 and box.y1 <= whole.y1
    assert ax.get_aspect() == 1.0


def test_starts_field_and_directions_are_shown():
    square = carom.system("magnetic-square")
    drawn = square.plot().get_title()
    assert "ω" in drawn and "clockwise" in drawn
    assert "ω" not in square.plot(field=False).get_title()
    point = square.with_(initial={"kind": "point", "position": [0.5, 0.25], "velocity": [1, 1]})
    dots = [line.get_xydata().tolist() for line in point.plot().get_lines()]
    assert [[0.5, 0.25]] in dots
    assert len(square.plot(starts=7).get_lines()[-1].get_xydata()) == 7


def test_rates_are_those_of_the_result():
    result = carom.escape("magnetic-square", trajectories=2000)
    ax = carom.plot.rate(result)
    drawn = ax.get_lines()[0].get_xydata()
    seen = result.rate[(result.rate["value"] > 0) & (result.rate["t"] > 0)]
    assert numpy.array_equal(drawn[:, 1], seen["value"])


def test_energies_are_drawn_where_there_are_some():
    run = carom.run("wigner", t_max=1, sample=0.1)
    ax, change = carom.plot.energy(run)
    assert change.get_lines()[0].get_ydata()[0] == 0
    lines = {line.get_label(): line.get_ydata() for line in ax.get_lines()}
    assert numpy.array_equal(lines["total"], run.energies["total"])
    with pytest.raises(ValueError):
        carom.plot.energy(carom.run("stadium", collisions=3))


def test_an_orbit_is_coloured_by_time():
    run = carom.run("stadium", collisions=20)
    lines = [one for one in run.plot(by="time").collections if one.get_array() is not None]
    assert lines[0].get_array().max() == run.path()["t"][-2]


def test_basins_are_a_grid_where_the_starts_are():
    table = carom.stadium(1, 1).hole("bottom", center=0.5, width=0.4, name="left")
    table = table.hole("bottom", center=1.5, width=0.4, name="right")
    grid = [[x, y, 0.6, 0.8] for x in (-0.5, 0.0, 0.5) for y in (-0.5, 0.1)]
    result = carom.escape(
        table, initial={"kind": "list", "starts": grid}, trajectories=6, per_trajectory=True
    )
    mesh = carom.plot.basins(result).collections[0]
    rows = result.per_trajectory
    assert numpy.array_equal(numpy.sort(mesh.get_array().ravel()), numpy.sort(rows["hole"]))
    uniform = carom.escape(table, trajectories=50, per_trajectory=True)
    for colour in ("hole", "time", "hits"):
        assert len(carom.plot.basins(uniform, colour=colour).collections[0].get_offsets()) == 50
    with pytest.raises(ValueError):
        carom.plot.basins(carom.escape(table, trajectories=5))


def test_exponents_over_a_grid_at_the_wall(tmp_path):
    grid = {"from": "-0.9", "to": "0.9", "count": 4}
    start = {"kind": "birkhoff", "wall": "circle", "s": {"from": 0, "to": 5, "count": 3}, "v_parallel": grid}
    table = carom.circle(1).obstacle("circle", center=[0.3, 0], radius=0.2)
    result = carom.lyapunov(table, initial=start, trajectories=12, t_max=50, per_trajectory=True)
    rows = result.per_trajectory
    mesh = result.plot(what="exponents").collections[0]
    assert numpy.array_equal(numpy.sort(mesh.get_array().ravel()), numpy.sort(rows["lambda"]))
    assert numpy.allclose(numpy.unique(rows["s"].round(9)), [0, 2.5, 5])
    assert (rows["sali"] <= 2**0.5).all() and abs(result.lambda_[0]["value"] - rows["lambda"].mean()) < 1e-12
    result.save(tmp_path / "map.h5")
    again = carom.open(tmp_path / "map.h5").per_trajectory
    assert all(numpy.array_equal(again[name], rows[name]) for name in rows.dtype.names)


@pytest.mark.parametrize("name", ["stadium", "wigner"])
def test_films_are_made(name, tmp_path):
    carom.animate(name, tmp_path / "film.gif", frames=4, t_max=1)
    assert (tmp_path / "film.gif").read_bytes().startswith(b"GIF")
    film = carom.animate(carom.run(name, t_max=2, sample=0.1), frames=5)
    assert len(list(film.new_frame_seq())) == 5
    film._draw_was_started = True  # it is not shown, and that is no mistake


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="ffmpeg is not installed")
def test_films_are_made_by_ffmpeg(tmp_path):
    carom.animate("stadium", tmp_path / "film.mp4", frames=4, t_max=1)
    assert b"ftyp" in (tmp_path / "film.mp4").read_bytes()[:12]


def test_what_films_need_is_named(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(carom.InputError, match="nothing here writes such films") as error:
        carom.animate("stadium", "film.mp4")
    assert "ffmpeg" in error.value.expected and ".gif" in error.value.expected
    with pytest.raises(carom.InputError):
        carom.animate("stadium", "film.avi")


def test_the_decay_is_drawn_in_its_window():
    result = carom.escape("stadium", trajectories=100_000, window=(100, 400))
    assert result.fit.model == "exponential"
    line = carom.plot.survival(result).get_lines()[-1]
    assert line.get_label().startswith("exponential\nκ = ")
    assert list(line.get_xdata()[[0, -1]]) == result.fit.window
    t, p = result.survival["t"], result.survival["p"]
    fitted = numpy.interp(t, line.get_xdata(), line.get_ydata())
    inside = (t > result.fit.window[0]) & (t < result.fit.window[1])
    assert inside.sum() > 3 and numpy.allclose(fitted[inside], p[inside], rtol=0.1)


def test_a_decay_in_a_short_window_is_a_local_slope():
    result = carom.escape("stadium", trajectories=100_000, t_max=500, window=(100, 150))
    assert result.fit.local_slope
    line = carom.plot.survival(result).get_lines()[-1]
    assert line.get_label().startswith("local slope, exponential\nκ = ")


def test_the_legend_of_a_decay_covers_no_curve():
    plateau = carom.escape("mushroom", trajectories=20_000)
    for result in (plateau, carom.escape("circle", trajectories=20_000)):
        axes = result.plot()
        axes[0].figure.canvas.draw()
        for ax in axes:
            box = ax.get_legend().get_window_extent()
            curve = ax.get_lines()[0].get_path().interpolated(50).vertices
            assert result.fit.model and not any(box.contains(*place) for place in ax.transData.transform(curve))


def test_decays_beside_curves_of_a_colour_have_their_label():
    result = carom.escape("circle", trajectories=20_000)
    line = carom.plot.survival(result, color="red", label="mine").get_lines()[-1]
    assert result.fit.model and line.get_label().startswith("mine: ") and line.get_color() != "red"


def test_a_share_that_stays_has_plain_numbers():
    ax = carom.plot.survival(carom.escape("sinai", trajectories=100, t_max=5))
    assert ax.get_ylim()[0] <= 0.5
    carom.plot.survival(carom.escape("three-disc", trajectories=1000), ax=ax)
    assert ax.get_ylim()[0] < 0.1  # the first has not fixed the range


def test_few_short_times_take_no_colours():
    result = carom.escape("mushroom", trajectories=2000, t_max=100, per_trajectory=True)
    (bar,) = carom.plot.times(result).child_axes
    assert bar.get_ylim()[0] > 5 * result.per_trajectory["time"].min()


def test_no_decay_is_drawn_where_the_data_tell_none():
    result = carom.escape("circle", trajectories=1000, collisions=5)
    assert result.fit.model is None and "cap on hits" in result.fit.reason
    assert not carom.plot.survival(result).get_legend()


def test_returns_are_drawn():
    ax = carom.returns("sinai", on="wall:disc", trajectories=300, t_max=20).plot()
    assert ax.get_xscale() == "log" and "disc" in ax.get_ylabel() and ax.containers


def test_every_picture_of_a_diffusion_is_drawn(tmp_path):
    result = carom.diffusion("lorentz-square", trajectories=500, t_max=30, free_paths=True)
    names = list(carom.plot.pictures(result))
    assert names == ["diffusion", "correlation", "free_paths"]
    for name in names:
        result.plot(what=name)
        pyplot.gcf().savefig(tmp_path / f"{name}.png", dpi=60)
        assert result.plot(what=name, ax=pyplot.figure().gca()).lines


def test_the_spectrum_is_drawn_with_its_entropy(tmp_path):
    result = carom.lyapunov("wigner", trajectories=2, t_max=5, spectrum=True)
    assert list(carom.plot.pictures(result)) == ["lyapunov", "convergence", "spectrum"]
    assert len(result.spectrum) == 20 and abs(result.spectrum["value"].sum()) < 1e-9
    assert result.entropy.value == pytest.approx(result.spectrum["value"][:6].sum())
    ax = result.plot(what="spectrum")
    ax.figure.savefig(tmp_path / "spectrum.png", dpi=60)
    assert (ax.containers[0].lines[0].get_ydata() == result.spectrum["value"]).all()
    result.save(tmp_path / "spectrum.h5")
    again = carom.open(tmp_path / "spectrum.h5")
    assert (again.spectrum == result.spectrum).all() and again.entropy == result.entropy


def test_starts_off_walls_have_no_place_on_them():
    inside = carom.escape(
        "stadium", trajectories=20, t_max=10, per_trajectory=True, initial={"kind": "uniform"}
    )
    with pytest.raises(carom.InputError, match="20 of 20 starts lie on no wall"):
        carom.plot.basins(inside, x="s", y="v_parallel")
    assert carom.plot.basins(inside).collections


def test_names_stand_beside_their_walls():
    ax = carom.system("stadium").plot()
    ax.figure.canvas.draw()
    renderer = ax.figure.canvas.get_renderer()
    boxes = [one.get_window_extent(renderer) for one in ax.texts if one.get_text()]
    walls = [ax.transData.transform(line.get_xydata()) for line in ax.get_lines()]
    assert len(boxes) >= 5
    for box in boxes:
        for wall in walls:
            along = numpy.concatenate([numpy.linspace(a, b, 50) for a, b in zip(wall[:-1], wall[1:])])
            assert not box.count_contains(along)


@pytest.mark.parametrize(
    "value, error, text",
    [
        (0.342849, 0.00054, "0.34285(54)"), (0.018864, 9.96e-5, "0.01886(10)"), (12.3, 0, "12.3"),
        (1234.5, 12.0, "1234(12)"), (-0.5, 0.095, "−0.500(95)"), (3.0, float("nan"), "3"),
        (-15400.0, None, "−1.54·10$^{4}$"), (0.0, 0.0, "0"),
    ],
)  # fmt: skip
def test_a_value_and_its_error_are_rounded_together(value, error, text):
    assert with_error(value, error) == text


def test_no_line_joins_different_laws():
    result = carom.escape("magnetic-square", trajectories=20_000, sweep={"field.B": "lin:0.5:2.5:9"})
    laws = result.table["model"]
    known = numpy.isfinite(result.table["exponent"])
    assert len(set(laws[known])) > 1  # of what is tested here
    ax = carom.plot.sweep(result, y="exponent")
    joined = [container.lines[0].get_xdata() for container in ax.containers]
    assert sorted(numpy.concatenate(joined)) == sorted(result.table["field.B"][known])
    for part in joined:
        places = numpy.searchsorted(result.table["field.B"], part)
        assert len(set(laws[places])) == 1 and (numpy.diff(places) == 1).all()
    assert result.plot().get_ylabel() == "$p(T)$"  # what all values have


def test_undecided_values_are_hollow():
    result = carom.escape("magnetic-square", trajectories=10_000, sweep={"field.B": "lin:0.5:2.5:9"})
    undecided = [row["values"]["field.B"] for row in result.json["sweep"] if row["fit"].get("decided") is False]
    known = result.table["field.B"][numpy.isfinite(result.table["exponent"])]
    assert undecided  # what is tested here
    hollow = [one for one in carom.plot.sweep(result, y="exponent").get_lines() if one.get_markerfacecolor() == "white"]
    drawn = sorted(x for line in hollow for x in line.get_xdata())
    assert drawn == sorted(x for x in known if any(abs(x - float(one)) < 1e-12 for one in undecided))


def test_cells_of_a_logarithmic_plane_are_around_their_values():
    result = carom.escape("stadium", trajectories=50, t_max=20, sweep={"field.B": "log:0.01:1:5", "run.seed": [1, 2]})
    ax = result.plot()
    corners = ax.collections[0].get_coordinates()
    edges = corners[0, :, 0]
    assert ax.get_xscale() == "log" and edges[0] > 0
    assert numpy.allclose(edges[1:] / edges[:-1], 10**0.5) and (edges[:-1] < result.table["field.B"][::2]).all()


def test_edges_of_regions_are_no_walls_and_fields_in_them_are_said():
    strip = carom.rectangle(4, 2).obstacle("circle", name="dot", center=(1, 1), radius=0.5).region("dot", B=-2).with_(B=2)
    ax = strip.plot(names=False)
    assert "−2 … 2, both ways" in ax.get_title()
    widths = [line.get_linewidth() for line in ax.get_lines()]
    assert sorted(set(widths)) == [0.6, 1.2] and widths.count(0.6) == 1


def test_a_colour_bar_is_as_high_as_its_picture():
    ax = carom.run("stadium", collisions=20).plot(by="time")
    ax.figure.canvas.draw()
    (bar,) = ax.child_axes
    heights = [one.get_window_extent().height for one in (ax, bar)]
    assert heights[0] == pytest.approx(heights[1])


def test_starts_on_walls_are_drawn_in_phase_space():
    result = carom.escape("stadium", trajectories=100, t_max=50, per_trajectory=True)
    rows = result.per_trajectory
    ax = result.plot(what="times")
    lengths = [wall["length"] for wall in carom.table("stadium").json["walls"]]
    places = rows["s"] + numpy.concatenate([[0], numpy.cumsum(lengths)])[rows["wall"]]
    assert numpy.allclose(ax.collections[0].get_offsets()[:, 0], places) and ax.get_xlabel() == "$s$"


def test_a_repeller_is_drawn_by_its_kicks():
    result = carom.lyapunov("three-disc", trajectories=20_000)
    assert list(carom.plot.pictures(result)) == ["convergence"]
    assert len(result.plot().containers[0].lines[0].get_xdata()) == 3


def test_results_share_a_picture():
    figure, ax = pyplot.subplots()
    for width, colour in ((0.1, "tab:red"), (0.3, "tab:green")):
        square = carom.rectangle(1, 1).hole("bottom", center=0.5, width=width)
        result = carom.escape(square, trajectories=500)
        result.plot(ax=ax, color=colour, label=f"hole of {width}", lw=2)
    assert {line.get_color() for line in ax.get_lines() if line.get_linewidth() == 2} == {"tab:red", "tab:green"}
    assert {"hole of 0.1", "hole of 0.3"} <= {text.get_text() for text in ax.get_legend().get_texts()}


def test_each_orbit_has_a_panel_with_its_word():
    panels = carom.orbits("three-disc", hits=4).plot()
    assert [ax.get_title().split("\n")[0] for ax in panels] == ["12", "123", "1213"]
    assert panels.figure is panels[0].figure


@pytest.mark.parametrize(
    ("key", "words"),
    [("field.B", symbol("B")), ("table.stem_width", "stem width"), ("table.hole[0].width", "hole width"),
     ("table.hole[1].width", "hole[1] width"), ("potential[0].parameters.k", "$k$"), ("s", "$s$")],
)  # fmt: skip
def test_keys_on_axes_are_words(key, words):
    assert symbol(key) == words
