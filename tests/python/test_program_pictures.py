"""carom plot, and -o PICTURE of every command."""

import os
import pathlib
import subprocess

import PIL.Image
import pytest


@pytest.fixture
def carom(tmp_path):
    def run(*arguments, status=0):
        done = subprocess.run(
            [os.environ["CAROM_PROGRAM"], *map(str, arguments)],
            capture_output=True, text=True, check=False, cwd=tmp_path,
        )
        assert done.returncode == status, done.stderr
        return done

    return run


BEGINNINGS = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}


def is_picture(path):
    return pathlib.Path(path).read_bytes().startswith(BEGINNINGS[pathlib.Path(path).suffix])


@pytest.mark.parametrize("ending", BEGINNINGS)
def test_a_system_is_drawn(carom, tmp_path, ending):
    carom("plot", "mushroom", "-o", f"mushroom{ending}")
    assert is_picture(tmp_path / f"mushroom{ending}")


def test_a_table_is_drawn_as_a_system_is(carom, tmp_path):
    said = carom("table", "stadium", "--set", "table.half_length=2", "--json", "-o", "stadium.svg").stdout
    assert '"drawing": "stadium.svg"' in said and is_picture(tmp_path / "stadium.svg")
    carom("table", "stadium", "-o", "stadium.svg", status=1)  # it is there already
    carom("plot", "stadium", "-o", "other.svg")
    assert (tmp_path / "other.svg").stat().st_size != (tmp_path / "stadium.svg").stat().st_size


def test_a_file_without_a_title_is_known_by_its_name(carom, tmp_path):
    (tmp_path / "mine.toml").write_text('[table]\nshape = "circle"\nradius = 1\n', encoding="utf-8")
    carom("table", "./mine.toml", "-o", "mine.svg")
    assert "./mine.toml" in (tmp_path / "mine.svg").read_text(encoding="utf-8")


def test_help_names_the_pictures(carom):
    said = "".join(carom("plot", "--help").stdout.split())
    for name in ("energy", "rate", "times", "correlation", "free_paths", "convergence", "spectrum", "exponents"):
        assert f"|{name}" in said


def test_an_archive_is_drawn(carom, tmp_path):
    carom("run", "ellipse-magnetic", "--collisions", 20, "-o", "orbit.h5", "--quiet")
    assert carom("plot", "orbit.h5").stdout == "picture: orbit.png\n"
    assert is_picture(tmp_path / "orbit.png")
    assert carom("plot", "orbit.h5", "--what", "orbit").stdout == "picture: orbit-orbit.png\n"
    carom("plot", "orbit.h5", status=1)  # it is there already
    carom("plot", "orbit.h5", "--force")


def test_an_archive_has_several_pictures(carom, tmp_path):
    carom("escape", "three-disc", "--trajectories", 500, "--per-trajectory", "-o", "e.h5", "--quiet")
    carom("run", "henon-heiles", "--t-max", 2, "--set", "run.sample=0.1", "-o", "r.h5", "--quiet")
    drawn = set()
    for archive, pictures in {"e": ("survival", "rate", "basins"), "r": ("orbit", "energy")}.items():
        for what in pictures:
            carom("plot", f"{archive}.h5", "--what", what, "-o", f"{what}.png")
            drawn.add((tmp_path / f"{what}.png").read_bytes())
    assert len(drawn) == 5
    said = carom("plot", "r.h5", "--what", "energies", "-o", "no.png", status=1).stderr
    assert "orbit or energy" in said and "Traceback" not in said
    said = carom("plot", "stadium", "--what", "rate", "-o", "no.png", status=1).stderr
    assert "table" in said and not (tmp_path / "no.png").exists()


def test_a_certified_run_has_no_picture(carom, tmp_path):
    command = ("run", "stadium", "--collisions", 3, "--precision", "certified", "--quiet")
    carom(*command, "-o", "exact.h5")
    assert "Traceback" not in carom("plot", "exact.h5", status=1).stderr


def test_a_sweep_without_results_has_no_picture(carom, tmp_path):
    unresolved = ("soft-lorentz", "--sweep", "integrator.step=list:0.8,0.9", "--trajectories", 5)
    carom("lyapunov", *unresolved, "-o", "none.h5", "--quiet", status=3)
    said = carom("plot", "none.h5", status=1).stderr
    assert "no value of the sweep" in said and "Traceback" not in said


@pytest.mark.parametrize(
    "command",
    [
        ("run", "ellipse-magnetic", "--collisions", 20),
        ("escape", "three-disc", "--trajectories", 1000),
        ("diffusion", "sinai", "--trajectories", 200, "--t-max", 20),
        ("lyapunov", "sinai", "--trajectories", 200, "--t-max", 20),
        ("section", "ellipse-magnetic", "--points", 20, "--orbits", 5),
        ("orbit", "three-disc", "--hits", 3),
    ],
)
def test_a_command_draws_its_result(carom, tmp_path, command):
    report = carom(*command, "-o", "result.png", "--quiet").stdout
    assert is_picture(tmp_path / "result.png")
    assert "archive" not in report and report.endswith("\npicture: result.png\n")
    assert list(tmp_path.iterdir()) == [tmp_path / "result.png"]


def test_a_film_is_made(carom, tmp_path):
    carom("run", "ellipse-magnetic", "--collisions", 3, "-o", "orbit.h5", "--quiet")
    carom("animate", "orbit.h5", "--frames", 4)
    assert (tmp_path / "orbit.gif").read_bytes().startswith(b"GIF")
    assert "orbit.gif" in carom("animate", "orbit.h5", status=1).stderr
    carom("escape", "stadium", "--trajectories", 10, "-o", "escape.h5", "--quiet")
    assert "no moving particles" in carom("animate", "escape.h5", status=1).stderr
    assert ".mp4" in carom("animate", "orbit.h5", "-o", "orbit.png", status=1).stderr
    carom("animate", "orbit.h5", "-o", "few.gif", "--frames", 3, "--fps", 5, "--trail", 2)
    film = PIL.Image.open(tmp_path / "few.gif")
    assert film.n_frames == 3 and film.info["duration"] == 200
    for name, text in (("frames", 0), ("fps", "fast"), ("trail", -1)):
        assert f"--{name}: '{text}'" in carom("animate", "orbit.h5", "--force", f"--{name}={text}", status=1).stderr


def test_other_endings_are_refused(carom, tmp_path):
    done = carom("run", "stadium", "--collisions", 5, "-o", "orbit.gif", status=1)
    assert "orbit.gif" in done.stderr and ".png" in done.stderr
    assert not list(tmp_path.iterdir())


def test_what_is_missing_is_said(carom, tmp_path, monkeypatch):
    assert "nosuch" in carom("plot", "nosuch", status=1).stderr
    monkeypatch.setenv("CAROM_PYTHON", str(tmp_path / "no-python"))
    for command in (("plot", "mushroom"), ("run", "stadium", "--collisions", 5, "-o", "mushroom.png")):
        said = carom(*command, status=1).stderr
        assert "./dev python" in said and "Traceback" not in said
    assert not list(tmp_path.iterdir())
