"""The module gives what the program gives, to the last bit."""

import numpy
import pytest

import carom

# Times, and what depends on which thread flies which block.
CHANGING = ("seconds", "cpu_seconds", "archive", "threads", "decisions", "lanes")


DISCS = carom.rectangle(4, 4).with_(
    particles={"count": 6}, interaction={"kind": "hard-discs", "radius": 0.25}
)


def same(result, printed):
    for key, value in printed.items():
        if key not in CHANGING:
            assert result.json[key] == value, key


@pytest.mark.parametrize("name", ["magnetic-square", "three-disc", "soft-lorentz", "mushroom"])
def test_escape(program, name):
    result = carom.escape(name, trajectories=500, t_max=20)
    same(result, program("escape", name, "--trajectories", 500, "--t-max", 20))
    assert result.survival["p"][0] <= 1


@pytest.mark.parametrize("name", ["lorentz-triangular", "sinai"])
def test_diffusion(program, name):
    result = carom.diffusion(name, trajectories=1000, t_max=50)
    same(result, program("diffusion", name, "--trajectories", 1000, "--t-max", 50))


def test_returns(program, tmp_path):
    result = carom.returns("sinai", on="wall:disc", trajectories=300, t_max=20)
    same(result, program("returns", "sinai", "--on", "wall:disc", "--trajectories", 300, "--t-max", 20))
    assert abs(result.mean_time.value - result.expected_time) < 5 * result.mean_time.stderr
    result.save(tmp_path / "returns.h5")
    opened = carom.open(tmp_path / "returns.h5")
    assert (opened.return_times == result.return_times).all() and opened.digest == result.digest


def test_lyapunov(program):
    result = carom.lyapunov("sinai", trajectories=300, t_max=20)
    same(result, program("lyapunov", "sinai", "--trajectories", 300, "--t-max", 20))
    assert result.lambda_[0]["value"] == -result.lambda_[3]["value"] > 0
    assert result.distribution["count"].sum() == result.orbits == 300


def test_what_exponents_do_not_tell_is_none():
    short = carom.lyapunov("stadium", trajectories=50, t_max=20)
    assert short.chaotic_share is None and "--t-max" in short.no_share
    assert short.regularity.regular == 0
    regular = carom.lyapunov(carom.circle(1), trajectories=20, t_max=20)
    assert regular.law == "linear" and regular.lambda_[0]["value"] == 0.0 == regular.chaotic_share.value
    regular.plot()


def test_nothing_to_measure_is_refused_as_by_the_program():
    with pytest.raises(carom.InputError, match="too few to keep populations alive"):
        carom.lyapunov("three-disc", trajectories=10)
    with pytest.raises(carom.InputError, match="no value measures an exponent; run.seed = 1 and 1 more"):
        carom.lyapunov("three-disc", trajectories=10, sweep={"run.seed": [1, 2]})
    mixed = carom.lyapunov("stadium", trajectories=20, sweep={"run.t_max": [20, 2000]})
    assert mixed.results[0].orbits > 0 == mixed.results[1].orbits


WELL = """
potential = [{ kind = "expression", expression = "(x^2 + y^2)/2 + x^4/40" }]
initial = { kind = "list", starts = [[1, 0, 0, 0.5], [0.5, 0.3, 0.3, 0.4]] }
integrator.energy_tolerance = 1e-13
section.on = "x=0.25"
run.t_max = 200
"""


@pytest.mark.parametrize("command", ["run", "escape", "diffusion", "section"])
def test_a_chosen_step_is_halved(program, tmp_path, command):
    (tmp_path / "well.toml").write_text(WELL)
    result = getattr(carom, command)(tmp_path / "well.toml")
    assert result.json["step_halvings"] >= 1 and "halved" in str(result)
    same(result, program(command, tmp_path / "well.toml"))


@pytest.mark.parametrize(
    "name, keywords, options",
    [
        ("stadium", {"collisions": 50}, ["--collisions", 50]),
        ("ellipse-magnetic", {"collisions": 50}, ["--collisions", 50]),
        ("henon-heiles", {"t_max": 20}, ["--t-max", 20]),
        ("wigner", {"t_max": 3}, ["--t-max", 3]),
    ],
)
def test_run(program, name, keywords, options):
    same(carom.run(name, **keywords), program("run", name, *options))


def test_section(program):
    result = carom.section("ellipse-magnetic", points=100, orbits=5)
    same_counts = program("section", "ellipse-magnetic", "--points", 100, "--orbits", 5)
    assert result.digest == same_counts["digest"]
    assert len(result.points) == same_counts["points"]


def test_orbits(program, tmp_path):
    result = carom.orbits("sinai", hits=3, starts=500, tries=50)
    same(result, program("orbit", "sinai", "--hits", 3, "--starts", 500, "--tries", 50))
    zeta = carom.orbits("three-disc", hits=4, zeta=True, certify=True, digits=25)
    options = ("--hits", 4, "--zeta", "--certify", "--digits", 25)
    same(zeta, program("orbit", "three-disc", *options))
    assert zeta.json["orbits"][0]["certified"]["period"] == "8." + 25 * "0"
    zeta.save(tmp_path / "saved.h5")
    stored = carom.open(tmp_path / "saved.h5")
    same(stored, {key: zeta.json[key] for key in zeta.json if key not in CHANGING})
    start, end = result.paths[0][0], result.paths[0][-1]
    assert end[0] == pytest.approx(result.orbits[0].period, rel=1e-14)
    assert numpy.array_equal(start[3:], end[3:])


def test_hits_are_those_of_the_archive(program, tmp_path):
    archive = tmp_path / "run.h5"
    run = carom.run("stadium", collisions=20)
    run.save(archive)
    more = program("run", "--resume", archive, "--collisions", 40)
    whole = carom.run("stadium", collisions=40)
    assert (more["x"], more["y"]) == (whole.x, whole.y)
    assert numpy.array_equal(run.hits, whole.hits[:20])


def test_a_run_that_was_opened_and_saved_knows_its_start(program, tmp_path):
    carom.run("soft-lorentz", trajectory=3, t_max=2).save(tmp_path / "run.h5")
    carom.open(tmp_path / "run.h5").save(tmp_path / "again.h5")
    more = program("run", "--resume", tmp_path / "again.h5", "--t-max", 4)
    whole = carom.run("soft-lorentz", trajectory=3, t_max=4)
    assert more["x"] == whole.x
    assert more["state_error"]["position"] == whole.state_error.position


@pytest.mark.parametrize("compute", [carom.escape, carom.diffusion, carom.lyapunov])
def test_an_archive_holds_the_same_result(program, tmp_path, compute):
    result = compute("lorentz-triangular", trajectories=500, t_max=10)
    result.save(tmp_path / "saved.h5")
    assert carom.open(tmp_path / "saved.h5").digest == result.digest
    with pytest.raises(carom.InputError):
        result.save(tmp_path / "saved.h5")
    result.save(tmp_path / "saved.h5", force=True)


def test_table(program):
    for name in ("mushroom", "lorentz-triangular", "three-disc"):
        same(carom.table(name), program("table", name))
    table = carom.table(carom.stadium(2, 1))
    assert table.walls["length"][0] == 4
    assert table.walls["from"].shape == (4, 2)


def test_validation(program):
    result = carom.validate(scale=0.001)
    printed = program("validate", "--scale", 0.001)
    assert (result.passed, result.failed) == (printed["passed"], printed["failed"])
    changing = ("seconds", "cpu_seconds", "filter_share")
    for mine, its in zip(result.json["cases"], printed["cases"]):
        assert {k: v for k, v in mine.items() if k not in changing} == {
            k: v for k, v in its.items() if k not in changing
        }
    assert len(result.doubts) == result.failed
    assert f"{result.passed} passed" in str(result)


def test_splitting(program):
    keywords = {"population": 100, "repetitions": 4, "kick": 0.01}
    options = ("--population", 100, "--repetitions", 4, "--kick", 0.01)
    by_hits = carom.escape("three-disc", splitting="hits:lin:0:4:5", **keywords)
    same(by_hits, program("escape", "three-disc", "--splitting", "hits:lin:0:4:5", *options))
    by_time = carom.escape("three-disc", splitting=[2, 4, 6, 8], **keywords)
    same(by_time, program("escape", "three-disc", "--splitting", "2,4,6,8", *options))
    assert len(by_time.rate) > 0
    small = carom.escape("three-disc", splitting=[1, 2], population=4, repetitions=2, kick=0.01)
    assert "4 trajectories" in small.doubts[0]


def test_options_without_a_use_are_refused():
    for keywords in ({"digits": 5}, {"population": 5}):
        with pytest.raises(carom.InputError):
            carom.escape("stadium", trajectories=10, **keywords)
    with pytest.raises(carom.InputError, match="per_trajectory"):
        carom.escape("stadium", splitting="1,2", per_trajectory=True)


def test_archives_hold_contacts_energies_and_trajectories(tmp_path):
    run = carom.run(DISCS, t_max=3, sample=0.5)
    assert len(run.contacts) > 0 and len(run.energies) == 7
    run.save(tmp_path / "run.h5")
    stored = carom.open(tmp_path / "run.h5")
    for name in ("contacts", "energies", "samples", "hits"):
        assert numpy.array_equal(getattr(stored, name), getattr(run, name)), name
    result = carom.escape("stadium", trajectories=100, t_max=5, per_trajectory=True)
    result.save(tmp_path / "escape.h5")
    assert numpy.array_equal(
        carom.open(tmp_path / "escape.h5").per_trajectory, result.per_trajectory
    )
    carom.escape("stadium", trajectories=100, t_max=5).save(tmp_path / "plain.h5")
    assert carom.open(tmp_path / "plain.h5").per_trajectory is None


def test_energies_are_those_of_the_archive(program, tmp_path):
    archive = tmp_path / "its.h5"
    program("run", "henon-heiles", "--t-max", 5, "--set", "run.sample=0.5", "-o", archive)
    run = carom.run("henon-heiles", t_max=5, sample=0.5)
    assert numpy.array_equal(carom.open(archive).energies, run.energies)
    assert len(run.energies) == 11
