"""Short texts, values with errors, and hints for wrong names."""

import copy
import os
import pickle
import re
import subprocess
import sys
import warnings

import numpy
import pytest

import carom

PYTHON = os.environ.get("CAROM_PYTHON", sys.executable)  # which an emulator may run


@pytest.fixture(scope="module")
def diffusion():
    return carom.diffusion("lorentz-triangular", trajectories=500, t_max=30)


@pytest.fixture(scope="module")
def lyapunov():
    return carom.lyapunov("sinai", trajectories=100, t_max=20)


@pytest.fixture(scope="module")
def escape():
    return carom.escape("stadium", trajectories=20_000, t_max=300)


def test_a_value_has_its_error(diffusion):
    D = diffusion.D
    value, error = D
    assert (value, error) == (diffusion.json["D"]["value"], diffusion.json["D"]["stderr"])
    assert D == float(D) == D.value == D["value"] == value and D.error == D.stderr == D["stderr"] == error
    assert 2 * D == 2 * value and numpy.array([D, D]).shape == (2,) and f"{D:.3f}" == f"{value:.3f}"
    assert re.fullmatch(r"0\.\d+\(\d\d\)", str(D)) and f"{D}" == repr(D) == str(D)
    for again in (pickle.loads(pickle.dumps(D)), copy.deepcopy(D)):
        assert isinstance(again, carom.Estimate) and tuple(again) == tuple(D) and repr(again) == repr(D)


def test_more_than_a_value_and_an_error(lyapunov):
    share = lyapunov.chaotic_share
    assert share.low <= share <= share.high and set(share.keys()) >= {"value", "stderr", "low", "high"}
    assert pickle.loads(pickle.dumps(share)).low == share.low
    largest = lyapunov.lambda_[0]
    assert tuple(largest) == tuple(lyapunov.json["lambda"][0].values())
    assert [float(one) for one in lyapunov.lambda_] == list(lyapunov.lambda_["value"])
    assert type(lyapunov.lambda_["value"]) is numpy.ndarray


@pytest.mark.parametrize("value, error, text", [
    (0.342849, 0.00054, "0.34285(54)"), (1.5e-7, 2e-9, "1.500(20)e-7"), (123456.0, 3456.0, "1.235(35)e5"),
    (0.5, None, "0.5"), (2.0, 0.0, "2"),
])  # fmt: skip
def test_a_value_is_printed_with_its_error(value, error, text):
    assert str(carom.Estimate(value, error)) == text


def test_reports_in_short_have_no_long_numbers(escape, diffusion, lyapunov):
    print(escape.fit)
    assert str(escape.fit).count("\n") == 1 and re.match(r"(exponential|power).*: (rate|exponent) = ", str(escape.fit))
    key = "rate" if "rate" in escape.fit.keys() else "exponent"
    assert escape.fit[key] == escape.json["fit"][key] and escape.fit[key].error == escape.fit.stderr
    for one in (escape, escape.fit, escape.fit_hits, diffusion, diffusion.window, lyapunov, lyapunov.regularity,
                lyapunov.drift, lyapunov.lambda_[0], carom.orbits("three-disc", hits=2).orbits[0]):  # fmt: skip
        assert not re.search(r"\d{9}", repr(one)) and len(repr(one)) < 600, repr(one)
    none = carom.escape("circle", trajectories=100, collisions=5).fit
    assert str(none).startswith("no law: ")


def test_records_are_equal_where_all_digits_are(escape):
    again = carom.escape("stadium", trajectories=20_000, t_max=300)
    assert again.fit == escape.fit
    other = dict(escape.json["fit"], amplitude=numpy.nextafter(escape.json["fit"]["amplitude"], 2))
    assert carom.records.python_of(other) != escape.fit


@pytest.mark.parametrize("call, message", [
    (lambda: carom.sinai(r=0.5), "carom.sinai has no keyword 'r'; did you mean 'radius'?"),
    (lambda: carom.sinai(Radius=0.5), "did you mean 'radius'"),
    (lambda: carom.stadium(radius=-1), "^radius: must be positive"),
    (lambda: carom.sinai(radius=5), "^radius: the disc does not fit"),
    (lambda: carom.stadium().hole("bottom", 1, 20), "^width: the hole is wider"),
    (lambda: carom.stadium().obstacle("circle", center=(0, 0), r=7), "^r: unknown key"),
    (lambda: carom.system("sinai").hole("bottm", 1, 0.1), "^wall: unknown wall 'bottm'"),
    (lambda: carom.run("stadium", position=(0, 0), angle="45 foo"), "^initial.angle: unexpected 'f'"),
    (lambda: carom.escape("stadium", t_max=-1), "^t_max: must be positive"),
    (lambda: carom.orbits("stadium", hits=-2), "^hits: '-2' is not"),
    (lambda: carom.escape("stadium", trajectories=10, sweep={"B": "lin:0:1"}), "^sweep field.B: cannot read"),
    (lambda: carom.run("stadium", potential=lambda x, y: x), "Python function.* Type a formula: .*expression"),
    (lambda: carom.run("stadium", integrator=print), "'integrator' cannot be a Python function"),
])  # fmt: skip
def test_errors_speak_of_keywords(call, message):
    with pytest.raises(carom.InputError, match=message) as raised:
        call()
    assert "command line" not in str(raised.value) and ", line " not in str(raised.value)
    assert "--" not in str(raised.value)


def test_errors_in_files_have_their_lines(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text('[table]\nshape = "circle"\nradius = -1\n', encoding="utf-8")
    with pytest.raises(carom.InputError, match=r"own.toml, line 3, column 10: table.radius"):
        carom.load(file)


def test_wrong_columns_and_attributes_have_hints(escape, lyapunov):
    with pytest.raises(carom.InputError, match="no column 'P' among t, p, low, high; did you mean 'p'"):
        escape.survival["P"]
    with pytest.raises(AttributeError, match=r"read as rows\['p'\]"):
        escape.survival.p
    with pytest.raises(AttributeError, match="did you mean 'lambda_'"):
        lyapunov.lam
    with pytest.raises(AttributeError, match="did you mean 'survival'"):
        escape.surv
    with pytest.raises(AttributeError, match="did you mean 'rate'|did you mean 'exponent'"):
        escape.fit.rat if "rate" in escape.fit.keys() else escape.fit.exp
    run = carom.run("stadium", collisions=3)
    with pytest.raises(carom.InputError, match="no column 'T' among .*; did you mean 't'"):
        run.hits["T"]


def test_files_are_read_by_their_function():
    for call, name, function in (
        (carom.load, "x.h5", "carom.open"), (carom.system, "x.toml", "carom.load"), (carom.system, "x.h5", "carom.open"),
    ):  # fmt: skip
        with pytest.raises(carom.InputError, match=function):
            call(name)


def test_samples_must_be_asked_for():
    free, forced = carom.run("stadium", collisions=3), carom.run("henon-heiles", t_max=1)
    for run, names in ((free, ("samples", "energies")), (forced, ("samples", "energies"))):
        for name in names:
            with pytest.warns(UserWarning, match="sample=0.1"):
                assert len(getattr(run, name)) == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sampled = carom.run("stadium", collisions=3, sample=0.5)
        assert len(sampled.samples) > 0 and len(sampled.energies) == 0
        forced.plot()
        repr(forced)


def test_without_numpy_it_says_so(tmp_path):
    (tmp_path / "numpy.py").write_text("raise ImportError('no numpy')", encoding="utf-8")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import carom"
    done = subprocess.run([PYTHON, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and done.stderr.strip().endswith(
        "ImportError: carom needs NumPy (Debian: python3-numpy; pip install numpy)"
    )


class Handle:
    """Of what a notebook shows."""

    def __init__(self):
        self.shown = []

    def update(self, html):
        self.shown.append(html)


@pytest.fixture
def notebook(monkeypatch):
    """A notebook, and what it shows."""
    import types

    carom.axes.pyplot().figure()  # looks at IPython, which is none here
    carom.axes.pyplot().close()
    handle = Handle()

    def display(html, display_id):
        handle.shown.append(html)
        return handle

    shell = types.SimpleNamespace(kernel=None)
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.display", types.SimpleNamespace(HTML=str, display=display))
    return handle


def test_notebooks_show_progress(notebook):
    shown = carom.progress.progress_of(None)
    assert carom.progress.progress_of(False) is None
    shown.last -= 1
    shown(0.25, 1000)
    shown(0.26, 1001)  # too soon after it
    shown.last -= 1
    shown(0.5, 2000)
    shown.close()
    assert len(notebook.shown) == 3 and 'value="0.2500"' in notebook.shown[0] and "2000 done" in notebook.shown[1]
    assert notebook.shown[-1] == ""
    carom.escape("sinai", trajectories=100)


def test_notebooks_show_the_ensemble_so_far(notebook):
    open_before = carom.axes.pyplot().get_fignums()
    result = carom.lyapunov("sinai", trajectories=120_000, t_max=1000, threads=1)
    assert result.json["status"] == "completed" and notebook.shown[-1] == ""
    assert any("<progress" in html and "data:image/png;base64," in html for html in notebook.shown)
    assert carom.axes.pyplot().get_fignums() == open_before
