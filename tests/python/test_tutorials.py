"""Every tutorial runs from its first block to its last, at a small size: shell, files and Python.

A tutorial is Markdown with code blocks, which jupytext opens as a notebook.
"""

import os
import pathlib
import re
import subprocess

import matplotlib.pyplot as pyplot
import pytest

TUTORIALS = pathlib.Path(__file__).parents[2] / "docs" / "guide" / "tutorials"
PAGES = sorted(TUTORIALS.glob("*.md"))
# The sizes of the text, and what takes a moment.
SMALL = {
    "1e7": "2e4", "10**6": "20_000", "1e5": "50", "100_000": "2000", "20_000": "500", "4000": "200",
    "1000 -o": "50 -o", "log:1:1e4:41": "log:1:100:11", "--t-max 1e4": "--t-max 100",
    "t_max=10**4": "t_max=100", "hits:lin:0:12:13": "hits:lin:0:4:5", "--digits 100": "--digits 20",
    "--trajectories 200": "--trajectories 5", "t > 1000": "t > 20", "(t < 300)": "(t < 90)",
    "--t-max 1000": "--t-max 20", "log:1:1000:31": "log:1:20:5",
}  # fmt: skip
BLOCK = re.compile(r"^```(sh|python|toml)\n(.*?)^```", re.M | re.S)
NOT_EVERYWHERE = ("h5py", "mpmath")


def small(code):
    pattern = "|".join(map(re.escape, sorted(SMALL, key=len, reverse=True)))
    return re.sub(pattern, lambda found: SMALL[found.group()], code)


def sh(code, folder):
    program = pathlib.Path(os.environ["CAROM_PROGRAM"])
    path = f"{program.parent}:{os.environ['PATH']}"
    for line in code.replace("\\\n", " ").splitlines():
        options = "--trajectories 200" if re.match(r"carom diffusion", line) else ""
        done = subprocess.run(
            ["sh", "-c", f"{line} {options}"], cwd=folder, env={**os.environ, "PATH": path},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode in (0, 3), f"{line}\n{done.stderr}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    text = page.read_text(encoding="utf-8")
    for found in BLOCK.finditer(text):
        kind, code = found.group(1), small(found.group(2))
        if kind == "sh":
            sh(code, tmp_path)
        elif kind == "toml":
            name = re.findall(r"Write this to `([^`]+)`", text[: found.start()])[-1]
            (tmp_path / name).write_text(code, encoding="utf-8")
        else:
            try:
                exec(compile(code, f"{page.name} (python)", "exec"), names)
            except ModuleNotFoundError as error:
                assert error.name in NOT_EVERYWHERE
            pyplot.close("all")
    assert list(tmp_path.glob("*.png")) or list(tmp_path.glob("*.svg")), "it ends without a figure"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_has_a_question_shell_python_and_an_error(page):
    text = page.read_text(encoding="utf-8")
    assert "**Question.**" in text and "**Result.**" in text
    python = "".join(code for kind, code in BLOCK.findall(text) if kind == "python")
    assert "import carom" in python and "savefig(" in python
    assert re.search(r"carom \w+", "".join(code for kind, code in BLOCK.findall(text) if kind == "sh"))
    assert re.search(r"print\(f.*(±|95 %|between)", python), "no number with an error is printed"
