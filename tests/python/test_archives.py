"""Archives: opened by the module, and read by h5py without it."""

import os
import pathlib
import pickle
import re
import shutil
import signal
import subprocess
import threading

import numpy
import pytest

import carom

COMMANDS = {
    "run": ("run", "henon-heiles", "--t-max", 2, "--set", "run.sample=0.5"),
    "certified": ("run", "stadium", "--collisions", 12, "--precision", "certified", "--digits", 25),
    "escape": ("escape", "stadium", "--trajectories", 300, "--t-max", 20, "--per-trajectory"),
    "diffusion": ("diffusion", "lorentz-triangular", "--trajectories", 50, "--t-max", 5),
    "section": ("section", "stadium", "--orbits", 3, "--points", 40),
}


@pytest.fixture(scope="module")
def archives(tmp_path_factory):
    """Of each kind one, written by the program."""
    folder = tmp_path_factory.mktemp("archives")
    for kind, command in COMMANDS.items():
        words = [os.environ["CAROM_PROGRAM"], *map(str, command), "--quiet", "-o", f"{kind}.h5"]
        subprocess.run(words, check=True, capture_output=True, cwd=folder)
    return folder


@pytest.mark.parametrize("kind", COMMANDS)
def test_h5py_reads_texts_and_numbers(archives, kind):
    h5py = pytest.importorskip("h5py")
    with h5py.File(archives / f"{kind}.h5") as file:
        assert file.attrs["kind"] == kind
        assert file.attrs["status"] in ("completed", "escaped")
        assert isinstance(file["provenance"].attrs["version"], str)
        assert file["provenance"].attrs["seed"] == 1
        assert carom.System(file["system"].asstr()[()], kind).to_toml()
        others = []

        def look(name, thing):
            for key, value in thing.attrs.items():
                values = [value] if numpy.ndim(value) == 0 else list(value)
                if any(isinstance(one, (bytes, numpy.bytes_)) for one in values):
                    others.append(f"{name}@{key}")

        look("", file)
        file.visititems(look)
        assert others == ["provenance@checksums"]  # which is written again in place


def example_of(heading):
    """The Python of a section of docs/developer/archives.md."""
    page = pathlib.Path(__file__).parents[2] / "docs" / "developer" / "archives.md"
    section = page.read_text(encoding="utf-8").partition(f"\n## {heading}\n")[2]
    return re.search(r"```python\n(.*?)```", section, re.DOTALL).group(1)


@pytest.mark.parametrize("kind", COMMANDS)
def test_others_can_check_the_sums(archives, kind, tmp_path, monkeypatch, capsys):
    h5py = pytest.importorskip("h5py")
    monkeypatch.chdir(tmp_path)
    shutil.copy(archives / f"{kind}.h5", "result.h5")

    def check():
        names = {}
        exec(example_of("The list of checksums"), names)
        names["file"].close()

    check()
    assert capsys.readouterr().out == ""
    with h5py.File("result.h5", "r+") as file:
        file["system"][()] = "title = 'another one'"
    check()
    assert capsys.readouterr().out == "/system was changed\n"


def test_others_can_read_exact_sums(archives, tmp_path, monkeypatch):
    pytest.importorskip("h5py")
    monkeypatch.chdir(tmp_path)
    shutil.copy(archives / "diffusion.h5", "msd.h5")
    names = {}
    exec(example_of("Exact sums"), names)
    assert list(map(float, names["sums"])) == pytest.approx(list(names["groups"]["square"]))


def lasting(result):
    """The JSON of a result but for times."""
    return {key: value for key, value in result.json.items() if key not in ("seconds", "cpu_seconds")}


@pytest.mark.parametrize("kind", COMMANDS)
def test_every_archive_is_opened_and_pickled(archives, kind):
    opened = carom.open(archives / f"{kind}.h5")
    assert repr(pickle.loads(pickle.dumps(opened))) == repr(opened)
    assert str(opened).splitlines()[0] == opened.system.title
    again = archives / f"again-{kind}.h5"
    opened.save(again)
    assert lasting(carom.open(again)) == lasting(opened)


def test_a_certified_run_is_stored_with_all_digits(tmp_path):
    exact = carom.run("siam-photon", collisions=20, precision="certified", digits=40)
    exact.save(tmp_path / "exact.h5")
    for again in (carom.open(tmp_path / "exact.h5"), pickle.loads(pickle.dumps(exact))):
        assert isinstance(again, carom.Certified)
        assert again.x == exact.x and again.x.interval == exact.x.interval
        assert again.hits == exact.hits
        assert lasting(again) == lasting(exact)


def test_an_archive_has_what_pictures_need(archives):
    h5py = pytest.importorskip("h5py")
    with h5py.File(archives / "escape.h5") as file:
        walls = file["walls"]
        names = list(walls["name"].asstr()[:])
        assert names == ["bottom", "right", "top", "left"]
        assert numpy.isnan(walls["a"][names.index("top")])
        right = names.index("right")
        assert walls["kind"].asstr()[right] == "circular arc"
        assert walls["a"][right] == walls["b"][right] == 1.0
        assert (walls["from_angle"][right], walls["to_angle"][right]) == pytest.approx((-numpy.pi / 2, numpy.pi / 2))


def test_a_run_is_opened_with_its_start(tmp_path, program):
    program("run", "stadium", "--trajectory", 7, "--collisions", 5, "-o", tmp_path / "seventh.h5")
    made = carom.run("stadium", trajectory=7, collisions=5)
    opened = carom.open(tmp_path / "seventh.h5")
    assert numpy.array_equal(opened.starts, made.starts)
    assert not numpy.array_equal(carom.run("stadium", collisions=5).starts, made.starts)
    assert numpy.array_equal(opened.path(), made.path())
    assert numpy.array_equal(carom.run(opened.system).starts, made.starts)


def test_an_opened_result_says_what_its_archive_does_not_hold(tmp_path):
    carom.run("henon-heiles", t_max=5).save(tmp_path / "run.h5")
    opened = carom.open(tmp_path / "run.h5")
    assert opened.state_error is None and "archive" in opened.state_error_reason


def test_an_opened_result_has_the_time_of_its_computing(tmp_path):
    made = {
        "run": carom.run("stadium", collisions=20_000),
        "forces": carom.run("henon-heiles", t_max=5),
        "section": carom.section("stadium", orbits=20, points=100),
        "relax": carom.relax("wigner", starts=20),
        "orbits": carom.orbits("stadium", hits=2, starts=500),
        "escape": carom.escape("stadium", trajectories=200, t_max=10),
    }
    for name, result in made.items():
        result.save(tmp_path / f"{name}.h5")
        opened = carom.open(tmp_path / f"{name}.h5")
        assert result.seconds > 0 and result.cpu_seconds > 0
        assert (opened.seconds, opened.cpu_seconds) == (result.seconds, result.cpu_seconds), name


def test_an_opened_run_counts_as_it_did(tmp_path):
    made = carom.run("wigner", t_max=5, sample=0.3)
    made.save(tmp_path / "run.h5")
    opened = carom.open(tmp_path / "run.h5")
    for key in ("steps", "force_evaluations"):
        assert getattr(opened, key) == getattr(made, key)


def test_a_section_keeps_its_energy_error(tmp_path):
    made = carom.section(
        "henon-heiles", on="x=0", points=20, orbits=2, t_max=200,
        integrator={"step": 0.9, "scheme": "velocity-verlet"},
    )  # fmt: skip
    made.save(tmp_path / "section.h5")
    opened = carom.open(tmp_path / "section.h5")
    assert made.doubts and opened.doubts == made.doubts
    for key in ("energy_error", "steps", "force_evaluations"):
        assert getattr(opened, key) == getattr(made, key)


def test_ctrl_c_stops_saving_and_leaves_no_file(tmp_path):
    run = carom.run(carom.circle(), collisions=3_000_000)
    timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        run.save(tmp_path / "large.h5")
        timer.join()  # a fast machine was done before
    timer.join()
    assert not list(tmp_path.iterdir())


def test_names_of_archives_are_those_of_the_program(tmp_path):
    run = carom.run("stadium", collisions=3)
    run.save(tmp_path / "run.hdf5")
    opened = carom.open(tmp_path / "run.hdf5")
    for result in (run, opened):
        for name in ("run.png", "run.xyz"):
            with pytest.raises(carom.InputError, match="does not end as an archive"):
                result.save(tmp_path / name)
        with pytest.raises(carom.InputError, match="cannot write"):
            result.save(tmp_path / "nowhere/run.h5")
    assert [file.name for file in tmp_path.iterdir()] == ["run.hdf5"]
