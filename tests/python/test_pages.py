"""The commands and the Python of README and guide work as they are shown, at small sizes."""

import os
import pathlib
import re
import subprocess

import matplotlib.pyplot as pyplot
import pytest

ROOT = pathlib.Path(__file__).parents[2]
GUIDE = ROOT / "docs" / "guide"
# The commands of tutorials run in test_tutorials.py.
PAGES = [page for page in (ROOT / "README.md", *sorted(GUIDE.rglob("*.md"))) if page.parent.name != "tutorials"]
PYTHON = [ROOT / "README.md", *sorted((GUIDE / "coming-from").glob("*.md"))]
# Sizes that a test can afford; a command that is continued keeps its own.
SMALLER = (
    (r"--trajectories \S+", "--trajectories 100"),
    (r"--collisions \S+", "--collisions 300"),
    (r"--points \S+", "--points 20"),
    (r"--orbits \S+", "--orbits 3"),
    (r"--tries \S+", "--tries 20"),
    (r"--population \S+", "--population 50"),
    (r"--frames \S+", "--frames 3"),
    (r"--scale \S+", "--scale 0.0005"),
)
NEEDS = {"escape": "--trajectories 100", "diffusion": "--trajectories 100", "lyapunov": "--trajectories 50",
         "section": "--orbits 3 --points 20",
         "orbit": "--starts 200 --tries 20",
         "returns": "--trajectories 100 --t-max 100",
         "compare": "--t-max 10",
         "animate": "--frames 3",
         "validate": "--scale 0.0005"}  # fmt: skip


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)


def commands(page):
    """The lines of its shell blocks that call the program, without comments. `carom page` needs ./dev page."""
    for block in blocks(page, "(?:sh)?"):
        for line in re.sub(r"\\\n *", "", block).splitlines():
            line = re.sub(r"\s+#.*", "", line.strip())
            line = re.sub(r"^\./dev run ", "carom ", line)
            if line.startswith("carom page") and not (ROOT / "build/page/carom.html").exists():
                continue
            if line.startswith("carom "):
                yield line


def smaller(command):
    if "--resume" in command:
        return re.sub(r"--collisions \S+", "--collisions 400", command)
    for pattern, text in SMALLER:
        command = re.sub(pattern, text, command)
    for name, option in NEEDS.items():
        if command.startswith(f"carom {name} ") or command == f"carom {name}":
            if "--splitting" in command:
                option = "--population 50"
            missing = [f"{key} {value}" for key, value in re.findall(r"(--\S+) (\S+)", option) if key not in command]
            command = re.sub(rf"^carom {name}", " ".join([f"carom {name}", *missing]), command)
    if command.startswith("carom lyapunov three-disc"):  # populations that do not die out
        command = re.sub(r"--trajectories \S+", "--trajectories 15000", command)
    return command
# The same of Python.
SMALLER_PYTHON = (
    (r"100_000", "100"),
    (r"10\*\*[46]", "20"),
    (r"points=1000, orbits=20", "points=20, orbits=3"),
    (r"collisions=1000", "collisions=100"),
    (r"population=4000", "population=50"),
    (r"-0.99, 0.99, 200", "-0.99, 0.99, 10"),
    (r"scale=0.01", "scale=0.0001"),
    (r'"lorentz-triangular", sweep', '"lorentz-triangular", trajectories=100, t_max=100, sweep'),
    (r"50, 100\], speed=1", "50, 100], speed=1, trajectories=500"),
)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_commands_of_a_page(page, tmp_path):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/carom").symlink_to(os.environ["CAROM_PROGRAM"])
    environment = os.environ | {"PATH": f"{tmp_path}/bin:{os.environ['PATH']}"}

    def shell(command):
        # Pages write the same file in several ways.
        for output in re.findall(r"-o (\S+)|merge (?!-)(\S+)", command):
            (tmp_path / "".join(output)).unlink(missing_ok=True)
        return subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=tmp_path, env=environment,
                              capture_output=True, text=True, timeout=100)  # fmt: skip

    # What other pages have made.
    text = page.read_text(encoding="utf-8")
    shell("carom systems mushroom > my.toml")
    for part in (1, 2, 3) if "part-" in text else ():
        shell(f"carom escape stadium --trajectories 100 --shard {part}/3 -o part-{part}.h5")
    # A system file that the page shows has the name that the page uses next.
    for shown in re.finditer(r"^```toml\n(.*?)^```", text, re.M | re.S):
        name = re.search(r"\./(\w+\.toml)", text[shown.end() :])
        if name and not (tmp_path / name[1]).exists():
            (tmp_path / name[1]).write_text(shown[1], encoding="utf-8")
    failed, without_files = [], set()
    for command in commands(page):
        if smaller(command) in without_files:
            continue  # at this size it is one that has run
        if not re.search(r" -o |--resume|merge|plot|animate|>", command):
            without_files.add(smaller(command))
        done = shell(smaller(command))
        if done.returncode != 0:
            failed.append(f"{smaller(command)}: {done.stderr}")
    assert not failed, "\n".join(failed)


@pytest.mark.parametrize("page", PYTHON, ids=lambda page: page.stem)
def test_python_of_a_page(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for block in blocks(page, "python"):
        exec(compile(block, str(page), "exec"), {})
    pyplot.close("all")


def test_python_of_the_module(tmp_path, monkeypatch):
    """The page of the module: each block may use what those before it have made."""
    monkeypatch.chdir(tmp_path)
    page, names = GUIDE / "python.md", {}
    for block in blocks(page, "python"):
        for pattern, text in SMALLER_PYTHON:
            block = re.sub(pattern, text, block)
        if not block.startswith(">>>"):
            exec(compile(block, str(page), "exec"), names)
            continue
        call, told = re.fullmatch(r">>> (.*)\ncarom.errors.InputError: (.*)\n", block).groups()
        with pytest.raises(names["carom"].InputError) as caught:
            eval(call, names)
        assert str(caught.value) == told
    pyplot.close("all")
