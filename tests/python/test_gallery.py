"""Each script of the gallery draws its picture, at a small size, and the page shows the script."""

import pathlib
import re

import matplotlib.pyplot as pyplot
import pytest

GUIDE = pathlib.Path(__file__).parents[2] / "docs" / "guide"
SCRIPTS = sorted((GUIDE / "gallery").glob("*.py"))
# The sizes of the scripts, and what takes a moment. `./dev docs` runs the scripts as they are.
SMALL = {
    "trajectories=1_000_000": "trajectories=20_000", "trajectories=200_000": "trajectories=2000",
    "trajectories=50_000": "trajectories=2000",
    "trajectories=40_000": "trajectories=400", '"count": 200': '"count": 20', "4, 200)": "4, 20)", "0.5, 200)": "0.5, 20)",
    "trajectories=20_000": "trajectories=400", "trajectories=5000": "trajectories=300",
    "trajectories=2000": "trajectories=200", "t_max=100)": "t_max=20)", "t_max=2000": "t_max=100",
    "t_max=60": "t_max=10", "t_max=15": "t_max=5", "t_max=10,": "t_max=2,", "t_max=2,": "t_max=0.5,",
    "points=20_000": "points=500", "points=1000": "points=100", "points=500)": "points=50)",
    "orbits=60": "orbits=20", "100, 200, 500]": "100]",
}  # fmt: skip
SIZE = re.compile("|".join(map(re.escape, sorted(SMALL, key=len, reverse=True))))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_draws_its_picture(script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code = SIZE.sub(lambda found: SMALL[found.group()], script.read_text(encoding="utf-8"))
    exec(compile(code, script.name, "exec"), {})
    pyplot.close("all")
    assert (tmp_path / f"{script.stem}.png").stat().st_size > 3000
    assert (GUIDE / "gallery" / f"{script.stem}.png").exists()


def test_small_sizes_are_those_of_the_scripts():
    everything = "".join(script.read_text(encoding="utf-8") for script in SCRIPTS)
    assert [size for size in SMALL if size not in everything] == []


def test_the_page_shows_every_script():
    page = (GUIDE / "gallery.md").read_text(encoding="utf-8")
    for script in SCRIPTS:
        code = script.read_text(encoding="utf-8").split("\n", 1)[1].strip()
        assert code in page, script.name
        assert f"gallery/{script.stem}.png" in page
