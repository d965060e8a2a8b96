"""Every tutorial runs from its first block to its last, at a small size: shell, files and Python.

A tutorial is Markdown with code blocks, which docs/site/notebooks.py makes a notebook of.
"""

import importlib.util
import json
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
    "--trajectories 16 --t-max 50": "--trajectories 3 --t-max 10", '"arkode"])': '"arkode"], t_max=2)',
    "--t-max 1000": "--t-max 20", "log:1:1000:31": "log:1:20:5", 'y="exponent"': 'y="survival"',  # no law is found
}  # fmt: skip
_made = importlib.util.spec_from_file_location("notebooks", TUTORIALS.parents[1] / "site" / "notebooks.py")
notebooks = importlib.util.module_from_spec(_made)
_made.loader.exec_module(notebooks)
NOT_EVERYWHERE = ("h5py", "mpmath")


def small(code):
    pattern = "|".join(map(re.escape, sorted(SMALL, key=len, reverse=True)))
    return re.sub(pattern, lambda found: SMALL[found.group()], code)


def sh(code, folder):
    program = pathlib.Path(os.environ["CAROM_PROGRAM"])
    path = f"{program.parent}:{os.environ['PATH']}"
    for line in code.replace("\\\n", " ").splitlines():
        if line.startswith("carom lyapunov three-disc"):  # populations that do not die out
            line = re.sub(r"--trajectories \S+", "--trajectories 15000", line)
        options = {"diffusion": "--trajectories 200", "compare": "--t-max 2"}.get((line.split() + ["", ""])[1], "")
        done = subprocess.run(
            ["sh", "-c", f"{line} {options}"], cwd=folder, env={**os.environ, "PATH": path},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode in (0, 3), f"{line}\n{done.stderr}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_cells_of_a_tutorial_run_in_order(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    for cell in notebooks.notebook(page.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        source = small("".join(cell["source"]))
        magic, _, code = source.partition("\n") if source.startswith("%%") else ("", "", source)
        if magic == "%%sh":
            sh(code, tmp_path)
        elif magic:
            (tmp_path / magic.removeprefix("%%writefile ")).write_text(code + "\n", encoding="utf-8")
        else:
            try:
                exec(compile(code, f"{page.name} (python)", "exec"), names)
            except ModuleNotFoundError as error:
                assert error.name in NOT_EVERYWHERE
            pyplot.close("all")
    assert list(tmp_path.glob("*.png")) or list(tmp_path.glob("*.svg")), "it ends without a figure"


def test_every_command_of_a_tutorial_is_in_a_cell_of_the_shell():
    for page in PAGES:
        blocks = re.findall(r"^```\w*\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
        commands = re.findall(r"^(?:carom|\./dev run) .*", "".join(blocks), re.M)
        cells = notebooks.notebook(page.read_text(encoding="utf-8"))["cells"]
        shell = "".join("".join(cell["source"]) + "\n" for cell in cells if cell["cell_type"] == "code")
        lines = "".join(part for part in re.split(r"^(?=%%)", shell, flags=re.M) if part.startswith("%%sh")).splitlines()
        assert [command for command in commands if command not in lines] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_is_a_notebook(page, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    made = notebooks.write(page, tmp_path)
    nbformat.validate(json.loads(made.read_text(encoding="utf-8")))
    code = [cell for cell in nbformat.read(made, as_version=4).cells if cell.cell_type == "code"]
    text = page.read_text(encoding="utf-8")
    assert len(code) == sum(text.count(f"\n```{kind}\n") for kind in ("sh", "python", "toml"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_has_a_question_shell_python_and_an_error(page):
    text = page.read_text(encoding="utf-8")
    assert "**Question.**" in text and "**Result.**" in text
    python = "".join(code for kind, code in notebooks.BLOCK.findall(text) if kind == "python")
    assert "import carom" in python and "savefig(" in python
    assert re.search(r"carom \w+", "".join(code for kind, code in notebooks.BLOCK.findall(text) if kind == "sh"))
    assert re.search(r"print\(f.*(±|95 %|between)", python), "no number with an error is printed"
