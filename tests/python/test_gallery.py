"""Each script of the gallery draws its picture, and the page shows the script."""

import pathlib
import runpy

import matplotlib.pyplot as pyplot
import pytest

GUIDE = pathlib.Path(__file__).parents[2] / "docs" / "guide"
SCRIPTS = sorted((GUIDE / "gallery").glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_draws_its_picture(script, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(script))
    pyplot.close("all")
    assert (tmp_path / f"{script.stem}.png").stat().st_size > 3000
    assert (GUIDE / "gallery" / f"{script.stem}.png").exists()


def test_the_page_shows_every_script():
    page = (GUIDE / "gallery.md").read_text(encoding="utf-8")
    for script in SCRIPTS:
        code = script.read_text(encoding="utf-8").split("\n", 1)[1].strip()
        assert code in page, script.name
        assert f"gallery/{script.stem}.png" in page
