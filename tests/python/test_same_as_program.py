"""The module gives what the program gives, to the last bit."""

import numpy
import pytest

import carom

# Times, and what depends on which thread flies which block.
CHANGING = ("seconds", "cpu_seconds", "archive", "threads", "decisions", "lanes")


def same(result, printed):
    for key, value in printed.items():
        if key not in CHANGING:
            assert result.json[key] == value, key


@pytest.mark.parametrize("name", ["magnetic-square", "three-disc", "soft-lorentz", "mushroom"])
def test_escape(program, name):
    result = carom.escape(name, trajectories=2000, t_max=20)
    same(result, program("escape", name, "--trajectories", 2000, "--t-max", 20))
    assert result.survival["p"][0] <= 1


@pytest.mark.parametrize("name", ["lorentz-triangular", "sinai"])
def test_diffusion(program, name):
    result = carom.diffusion(name, trajectories=1000, t_max=50)
    same(result, program("diffusion", name, "--trajectories", 1000, "--t-max", 50))


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


def test_hits_are_those_of_the_archive(program, tmp_path):
    archive = tmp_path / "run.h5"
    run = carom.run("stadium", collisions=20)
    run.save(archive)
    more = program("run", "--resume", archive, "--collisions", 40)
    whole = carom.run("stadium", collisions=40)
    assert (more["x"], more["y"]) == (whole.x, whole.y)
    assert numpy.array_equal(run.hits, whole.hits[:20])


@pytest.mark.parametrize("compute", [carom.escape, carom.diffusion])
def test_an_archive_holds_the_same_result(program, tmp_path, compute):
    result = compute("lorentz-triangular", trajectories=500, t_max=10)
    result.save(tmp_path / "saved.h5")
    assert carom.open(tmp_path / "saved.h5").digest == result.digest
    with pytest.raises(carom.InputError):
        result.save(tmp_path / "saved.h5")
    result.save(tmp_path / "saved.h5", force=True)
