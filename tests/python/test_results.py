"""Results as Python objects."""

import os
import signal
import threading

import numpy
import pytest

import carom


@pytest.fixture(scope="module")
def escape():
    return carom.escape("magnetic-square", trajectories=1000, t_max=50, per_trajectory=True)


def test_keys_are_attributes(escape):
    assert escape.trajectories == 1000
    assert escape.escaped + escape.survived == 1000
    assert set(escape.survival.dtype.names) == {"t", "p", "low", "high"}
    assert "digest" in dir(escape)
    with pytest.raises(AttributeError, match="survival"):
        escape.survivl


def test_reports_can_be_read(escape):
    assert "trajectories" in str(escape)
    assert repr(escape).startswith("<carom.Escape of magnetic-square")
    assert escape._repr_html_().startswith("<pre>")
    assert escape.doubts == []


def test_each_trajectory_has_its_fate(escape):
    rows = escape.per_trajectory
    assert numpy.array_equal(rows["index"], numpy.arange(1000))
    escaped = carom.fates.index("escaped")
    assert (rows["fate"] == escaped).sum() == escape.escaped


def test_rows_are_not_copied_and_not_changed():
    run = carom.run(carom.stadium(), collisions=1000)
    assert len(run.hits) == 1000
    assert run._outcome.hits().ctypes.data == run.hits.ctypes.data
    with pytest.raises(ValueError):
        run.hits["t"][0] = 0.0
    del run


def test_a_path_meets_its_hits():
    for name in ("stadium", "ellipse-magnetic"):
        run = carom.run(name, collisions=20)
        path = run.path()
        for hit in run.hits:
            assert (path["t"] == hit["t"]).any()
        assert path["t"][-1] == run.t


def test_several_particles_are_a_table():
    run = carom.run("wigner", t_max=1)
    assert len(run.particles) > 1
    assert set(run.starts["particle"]) == set(range(len(run.particles)))


def test_ctrl_c_gives_what_is_done():
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt) as stopped:
        carom.escape("sinai", trajectories=10**9, t_max=1000)
    timer.join()
    result = stopped.value.result
    assert result.status == "interrupted"
    assert 0 <= result.trajectories < 10**9


def test_progress_is_told():
    seen = []
    carom.escape("sinai", trajectories=20000, progress=lambda share, done: seen.append(share))
    assert seen == sorted(seen)


def test_an_error_of_progress_stops_the_run():
    def fail(share, done):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        carom.escape("sinai", trajectories=10**9, progress=fail)


def test_certified_digits_are_decimals(program):
    table = carom.system("stadium").closed()
    start = {"position": ("1/10", "1/5"), "velocity": ("3/5", "4/5")}
    exact = carom.run(table, **start, collisions=100, precision="certified", digits=30)
    printed = program(
        "run", "stadium", "--set", "table.hole=[]", "--position", "1/10,1/5", "--velocity", "3/5,4/5",
        "--collisions", 100, "--precision", "certified", "--digits", 30,
    )  # fmt: skip
    assert str(exact.x) == printed["x"]
    low, high = exact.x.interval
    assert low < exact.x < high
    assert high - low < carom.Exact("1e-29", 30)
    assert len(exact.hits) == 100
    assert exact.hits[-1].x == exact.x
    double = carom.run(table, **start, collisions=20)
    for row, hit in zip(double.hits, exact.hits):
        assert row["x"] == pytest.approx(float(hit.x), abs=1e-6)


def test_ten_million_hits_are_handed_over_without_a_copy():
    run = carom.run(carom.circle(), collisions=10_000_000)
    assert run.hits.shape == (10_000_000,)
    before = resident()
    again = run.hits
    assert again.ctypes.data == run.hits.ctypes.data and not again.flags.owndata
    s = again["s"]
    assert s.base is not None and s.strides == (again.itemsize,)
    assert resident() - before < again.nbytes / 20


def resident():
    """Memory of this process, in bytes."""
    with open("/proc/self/statm", encoding="ascii") as stream:
        return int(stream.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_results_are_dataframes(escape):
    pandas = pytest.importorskip("pandas")
    frame = escape.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame.columns) == ["t", "p", "low", "high"]
    assert len(frame) == len(escape.survival)
    for result in (
        carom.run("stadium", collisions=5), carom.section("stadium", points=5, orbits=2),
        carom.diffusion("sinai", trajectories=200, t_max=10), carom.table("mushroom"),
        carom.lyapunov("sinai", trajectories=200, t_max=10),
        carom.run("stadium", collisions=3, precision="certified"),
        carom.orbits("three-disc", hits=3),
    ):  # fmt: skip
        assert len(result.to_dataframe()) > 0


def test_types_of_columns_do_not_depend_on_their_values():
    whole = {"t": 1, "n": 2, "at": [1, 0], "failure": None, "reversible": True}
    other = {"t": 0.5, "n": 3, "at": [0.5, 0], "failure": "none", "reversible": None}
    types = [("t", "f8"), ("n", "i8"), ("at", "f8", (2,)), ("failure", "U4"), ("reversible", "f8")]
    for rows in ([whole, whole], [whole, other], [other, other]):
        made = carom.records.table_of(rows, unknown=("reversible",)).dtype
        assert [made[name].base.kind for name in made.names] == ["f", "i", "f", "U", "f"]
    assert carom.records.table_of([whole, other], unknown=("reversible",)).dtype == numpy.dtype(types)
    # A bouncing ball: all its numbers are whole.
    found = carom.orbits("three-disc", hits=2)
    points = found.orbits[0].points
    assert (points["x"] == numpy.round(points["x"])).all()
    assert {points[name].dtype.kind for name in points.dtype.names if name != "wall"} == {"f"}


def test_columns_do_not_depend_on_the_number_of_rows():
    """An array without rows has the columns of one with rows."""
    stadium, few = carom.system("stadium"), {"trajectories": 20, "t_max": 20}
    pairs = [
        (carom.table(stadium.closed()).holes, carom.table(stadium).holes),
        (carom.escape(stadium.closed(), **few).holes, carom.escape(stadium, **few).holes),
        (carom.table("henon-heiles").walls, carom.table(carom.rectangle()).walls),
    ]
    for without, some in pairs:
        assert without.shape == (0,) and len(some) > 0
        assert without.dtype.names == some.dtype.names
        assert [without[n].dtype.kind for n in some.dtype.names] == [some[n].dtype.kind for n in some.dtype.names]
    columns = carom.lyapunov(stadium, **few).distribution.dtype
    assert columns == carom.Lyapunov._COLUMNS["distribution"]


def test_types_of_dataframes_do_not_depend_on_their_values():
    pytest.importorskip("pandas")
    frame = carom.orbits("three-disc", hits=2).to_dataframe()
    assert [str(frame[key].dtype) for key in ("hits", "period", "maslov")] == ["int64", "float64", "float64"]


def test_notebooks_show_tables_and_reports(escape):
    assert carom.system("mushroom")._repr_svg_().startswith("<?xml")
    for report in (escape, carom.table("stadium"), carom.section("stadium", points=5, orbits=1)):
        shown = report._repr_html_()
        assert shown.startswith("<pre>") and shown.endswith("</pre>")
        assert "<carom" not in shown


def test_results_are_pickled(escape):
    import pickle

    again = pickle.loads(pickle.dumps(escape))
    assert again.digest == escape.digest
    for name in escape.per_trajectory.dtype.names:  # starts off walls have no s
        no_number = name in ("s", "v_parallel")
        assert numpy.array_equal(
            again.per_trajectory[name], escape.per_trajectory[name], equal_nan=no_number
        )
    run = carom.run("henon-heiles", t_max=2, sample=0.5)
    assert numpy.array_equal(pickle.loads(pickle.dumps(run)).energies, run.energies)


def test_paths_of_hard_discs_turn_at_their_contacts():
    box = carom.rectangle(4, 4).with_(
        particles={"count": 6}, interaction={"kind": "hard-discs", "radius": 0.25}
    )
    run = carom.run(box, t_max=5)
    assert len(run.contacts) > 0
    for number in range(6):
        path = run.path(number)
        for axis in ("x", "y"):
            assert path[axis].min() > 0.25 - 1e-9 and path[axis].max() < 3.75 + 1e-9
    contact = run.contacts[0]
    path = run.path(int(contact["first"]))
    at = path[path["t"] == contact["t"]]
    assert at["x"][0] == contact["first_x"]


def test_a_diffusion_has_correlations_of_the_velocity():
    result = carom.diffusion("sinai", trajectories=500, times=[0, 1, 5])
    assert result.correlation.dtype.names == result.green_kubo.dtype.names == ("t", "value", "stderr")
    assert abs(result.correlation["value"][0] - 1) < 1e-12 and result.green_kubo["value"][0] == 0
    assert (result.green_kubo["stderr"][1:] > 0).all()


def test_a_diffusion_has_free_paths_where_they_are_asked_for():
    paths = carom.diffusion("sinai", trajectories=300, t_max=20, free_paths=True).free_paths
    assert abs(paths.mean.value - paths.expected_mean) < 5 * paths.mean.stderr
    for flights in (paths.between_hits, paths.at_start):
        assert flights.bins["longer"][0] == 1
        assert flights.bins["count"].sum() + flights.longer == flights.flights
