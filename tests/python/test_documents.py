"""Docstrings, and types: the stubs say what the compiled module has."""

import ast
import inspect
import pathlib
import re
import shutil
import subprocess

import pytest

import carom
from carom import _carom, plot, results

STUB = pathlib.Path(carom.__file__).with_name("_carom.pyi")
UNITS = ("length", "time", "share", "number", "name", "(TOML)", "1 or −1", "energy", "radians")


def arguments_of(function):
    """Names of the arguments, as pybind11 writes them into the docstring."""
    inside = re.match(r"\w+\((.*)\) ->", (function.__doc__ or "").splitlines()[0]).group(1)
    return re.findall(r"(?:^|, )(\w+): ", re.sub(r"\[[^][]*(\[[^][]*\][^][]*)*\]", "", inside))


def test_stubs_say_what_the_compiled_module_has():
    declared, classes = {}, {}
    for node in ast.parse(STUB.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            declared[node.name] = [one.arg for one in node.args.args]
        elif isinstance(node, ast.ClassDef):
            classes[node.name] = {
                one.name: (one.args, bool(one.decorator_list)) for one in node.body if isinstance(one, ast.FunctionDef)
            }
        elif isinstance(node, ast.AnnAssign):
            declared[node.target.id] = None
    there = {name for name in dir(_carom) if not name.startswith("_")}
    assert there == set(declared) | set(classes)
    for name, arguments in declared.items():
        if arguments is not None:
            assert arguments_of(getattr(_carom, name)) == arguments, name
    for name, members in classes.items():
        found = {key: one for key, one in vars(getattr(_carom, name)).items() if key[0] != "_"}
        assert found.keys() == members.keys(), name
        for key, (args, is_property) in members.items():
            assert isinstance(found[key], property) == is_property, (name, key)
            if not is_property:
                assert arguments_of(found[key]) == [one.arg for one in args.args], (name, key)


@pytest.mark.skipif(not shutil.which("mypy"), reason="mypy is not installed")
def test_types_fit(tmp_path):
    script = tmp_path / "use.py"
    script.write_text(
        "import carom\n"
        "table: carom.System = carom.stadium(1, 1).hole('bottom', center=1, width=0.2)\n"
        "area: float = carom.table(table).area\n"
        "passed: int = carom.validate(scale=0.01).passed\n"
    )
    command = ["mypy", "--ignore-missing-imports", "--no-error-summary", "--cache-dir", tmp_path / "cache"]
    folder = pathlib.Path(carom.__file__).parent
    done = subprocess.run(
        [*map(str, command), str(folder), str(script)], capture_output=True, text=True,
        cwd=folder.parent, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    script.write_text("import carom\nname: int = carom.system('stadium').name\n")
    done = subprocess.run(
        [*map(str, command), str(script)], capture_output=True, text=True, cwd=folder.parent, check=False
    )
    assert done.returncode == 1 and "str" in done.stdout


def public(thing):
    return [(name, getattr(thing, name)) for name in sorted(vars(thing)) if not name.startswith("_")]


def test_every_public_name_is_explained():
    silent = []
    for name, thing in public(carom):
        if inspect.isclass(thing) or inspect.isfunction(thing) or inspect.ismodule(thing):
            if not inspect.getdoc(thing):
                silent.append(name)
        if inspect.isclass(thing):
            members = vars(thing).items()
            for key, one in members:
                if key[0] != "_" and (callable(one) or isinstance(one, property)):
                    if not inspect.getdoc(one):
                        silent.append(f"{name}.{key}")
    for name, thing in public(plot):
        if inspect.isfunction(thing) and not inspect.getdoc(thing):
            silent.append(f"plot.{name}")
    assert not silent


def arrays():
    """Each array of the results, with the docstring that explains it."""
    run = carom.run("henon-heiles", t_max=2, sample=1)
    for name in ("hits", "samples", "contacts", "energies", "starts"):
        yield f"Run.{name}", getattr(run, name), inspect.getdoc(getattr(results.Run, name))
    yield "Run.path", run.path(), inspect.getdoc(results.Run.path)
    points = carom.section("stadium", points=5, orbits=1).points
    yield "Section.points", points, inspect.getdoc(results.Section.points)
    result = carom.escape("magnetic-square", trajectories=100, t_max=10, per_trajectory=True)
    yield "Escape.per_trajectory", result.per_trajectory, inspect.getdoc(results.Escape.per_trajectory)
    for name in ("survival", "survival_hits", "rate", "holes"):
        yield f"Escape.{name}", getattr(result, name), inspect.getdoc(results.Escape)
    table = carom.table("mushroom")
    for name in ("walls", "holes"):
        yield f"Table.{name}", getattr(table, name), inspect.getdoc(results.Table)
    validation = carom.validate(scale=0.001)
    yield "Validation.cases", validation.cases[:1], inspect.getdoc(results.Validation)


def test_shapes_and_units_of_arrays_are_said():
    for name, array, text in arrays():
        assert re.search(r"\([^)]*,\)", text), f"{name}: no shape"
        assert any(unit in text for unit in UNITS), f"{name}: no units"
        if name in ("Run.starts", "Validation.cases"):
            continue  # those of samples; those that matter
        for column in array.dtype.names:
            assert re.search(rf"\b{column}\b", text), f"{name}: '{column}' is not explained"


def test_lengths_of_shapes_are_called_lengths():
    shapes = (
        "rectangle", "polygon", "triangle", "regular", "circle", "ellipse", "annulus", "stadium",
        "mushroom", "lemon", "sinai", "lorentz", "discs", "cardioid", "limacon", "flower", "superellipse",
        "robnik", "egg", "polar", "parametric", "implicit", "spline", "svg",
    )  # fmt: skip
    for name in shapes:
        assert "length" in inspect.getdoc(getattr(carom, name)), name
