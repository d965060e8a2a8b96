"""Pickles and deep copies are the result: values, times, decisions, words."""

import copy
import pickle

import numpy
import pytest

import carom

FEW = {"trajectories": 50}
DISCS = carom.rectangle(4, 4).with_(
    particles={"count": 3}, interaction={"kind": "hard-discs", "radius": 0.2}
)
SPLITTING = {"splitting": "1,2,3", "population": 50, "repetitions": 4, "kick": 0.01}
MAKES = {
    "table": lambda: carom.table("mushroom"),
    "escape": lambda: carom.escape("stadium", **FEW),
    "escape, each": lambda: carom.escape("stadium", per_trajectory=True, threads=1, **FEW),
    "diffusion": lambda: carom.diffusion("lorentz-triangular", t_max=20, free_paths=True, **FEW),
    "lyapunov": lambda: carom.lyapunov("stadium", t_max=20, per_trajectory=True, **FEW),
    "spectrum": lambda: carom.lyapunov("wigner", t_max=5, trajectories=3, spectrum=True),
    "run": lambda: carom.run("magnetic-square", collisions=20),
    "run under forces": lambda: carom.run("soft-lorentz", t_max=5, sample=0.5),
    "run in steps": lambda: carom.run("stadium", engine="steps", integrator={"step": 0.01}, t_max=5),
    "run of discs": lambda: carom.run(DISCS, t_max=5, sample=1),
    "certified run": lambda: carom.run("stadium", collisions=10, precision="certified"),
    "section": lambda: carom.section("stadium", points=10, orbits=3),
    "relax": lambda: carom.relax("soft-lorentz", starts=5, saddles=True),
    "orbits": lambda: carom.orbits("three-disc", hits=3, zeta=True),
    "certified orbits": lambda: carom.orbits("three-disc", hits=2, certify=True),
    "compare": lambda: carom.compare("henon-heiles", t_max=2, schemes=["ruth-3"], steps=[0.1, 0.05]),
    "splitting": lambda: carom.escape("three-disc", **SPLITTING),
    "sweep": lambda: carom.escape("stadium", sweep={"field.B": [0.5, 1], "table.radius": [1, 2]}, **FEW),
    "sweep of splitting": lambda: carom.escape("three-disc", sweep={"table.radius": [1, 1.1]}, **SPLITTING),
    "validation": lambda: carom.validate(scale=1e-4),
}


def assert_same(a, b):
    """Of one type, with equal values to the last bit; rows may be padded with anything."""
    assert type(a) is type(b)
    if isinstance(a, carom.records.Report):
        assert_same_report(a, b)
    elif isinstance(a, numpy.ndarray):
        assert a.dtype == b.dtype and a.shape == b.shape
        for name in a.dtype.names or ():
            assert a[name].tobytes() == b[name].tobytes(), name
        assert a.dtype.names or a.tobytes() == b.tobytes()
    elif isinstance(a, (list, tuple)):
        assert len(a) == len(b)
        for one, other in zip(a, b):
            assert_same(one, other)
    elif isinstance(a, carom.Record):
        assert list(a.keys()) == list(b.keys())
        for key in a.keys():
            assert_same(a[key], b[key])
    else:
        assert a == b or (a != a and b != b)


def attributes(result):
    properties = [name for name in dir(type(result)) if isinstance(getattr(type(result), name, None), property)]
    return sorted({*result.json, *properties} - {"system", "json", "lambda"})


def assert_same_report(a, b):
    assert a.json == b.json and "seconds" in a.json
    assert (str(a), repr(a), a.doubts) == (str(b), repr(b), b.doubts)
    for name in attributes(a):
        assert_same(getattr(a, name), getattr(b, name))
    if isinstance(a.system, carom.System):
        assert a.system.to_toml() == b.system.to_toml() and a.system._options == b.system._options
    if isinstance(a, carom.Run):
        assert_same(a.path(), b.path())


@pytest.mark.parametrize("kind", MAKES)
def test_a_copy_is_the_result(kind):
    result = MAKES[kind]()
    pickled = pickle.loads(pickle.dumps(result))
    assert_same(result, pickled)
    assert_same(result, pickle.loads(pickle.dumps(pickled)))
    assert_same(result, copy.deepcopy(result))


@pytest.mark.parametrize("kind", ["escape, each", "run", "certified run", "sweep"])
def test_a_copy_is_saved_as_the_result(kind, tmp_path):
    result = MAKES[kind]()
    pickle.loads(pickle.dumps(result)).save(tmp_path / "copy.h5")
    opened = carom.open(tmp_path / "copy.h5")
    copied = pickle.loads(pickle.dumps(opened))
    (tmp_path / "copy.h5").unlink()
    assert opened.json == copied.json
    if kind == "sweep":  # its values are read from the copy alone
        assert [one.digest for one in copied] == [one.digest for one in result]
    else:
        assert_same(copied, copy.deepcopy(copied))


def test_what_is_done_before_ctrl_c_is_pickled():
    def stop(share, done):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as caught:
        carom.escape("stadium", trajectories=10**8, progress=stop)
    result = caught.value.result
    assert result.status == "interrupted"
    assert_same(result, pickle.loads(pickle.dumps(result)))


def test_the_report_of_a_table_does_not_change():
    table = carom.table("stadium")
    assert table.json == table.json
