"""Hits and trajectories in blocks: the bits of runs and ensembles, in any block, on any threads."""

import os
import signal
import threading
import time

import numpy
import pytest

import carom

DISCS = carom.rectangle(4, 4).with_(particles={"count": 4}, interaction={"kind": "hard-discs", "radius": 0.25})


def same(rows, others):
    """Bit for bit, in the columns that both have."""
    names = [name for name in others.dtype.names if name in rows.dtype.names]
    assert len(names) > 5 and len(rows) == len(others)
    return all(rows[name].tobytes() == others[name].tobytes() for name in names)


@pytest.mark.parametrize("name, keywords", [
    ("stadium", {"collisions": 3000, "trajectory": 5}),
    ("lorentz-triangular", {"collisions": 3000}),
    ("magnetic-square", {"collisions": 50}),
    ("henon-heiles", {"t_max": 20}),
    ("soft-lorentz", {"t_max": 5}),
    (DISCS, {"t_max": 20}),
    (carom.rectangle(), {"position": ("1/2", "1/2"), "velocity": (1, 1), "collisions": 8}),  # into corners
    (carom.polar("1 + 0.3*cos(3*phi)"), {"collisions": 1500}),
    (carom.circle().with_(table={"shape": "circle", "radius": 1, "wall": [{"law": "diffuse"}]}),
     {"collisions": 2000, "trajectory": 3}),
])  # fmt: skip
def test_hits_are_those_of_the_run(name, keywords):
    run = carom.run(name, **keywords)
    blocks = list(carom.hits(name, block=700, **keywords))
    assert [len(rows) for rows in blocks[:-1]] == [700] * (len(blocks) - 1)
    rows = numpy.concatenate(blocks) if blocks else run.hits[:0]
    assert len(run.hits) == 0 or same(rows, run.hits)
    assert len(rows) == 0 or (rows["trajectory"] == (keywords.get("trajectory") or 0)).all()


@pytest.mark.parametrize("name, isa", [("stadium", None), ("sinai", "baseline"), (DISCS, None)])
def test_hits_of_an_ensemble_are_those_of_its_runs(name, isa):
    ensemble = {"trajectories": 60, "t_max": 15, "isa": isa}
    rows = numpy.concatenate(list(carom.hits(name, block=1000, **ensemble)))
    assert (numpy.diff(rows["trajectory"].astype(int)) >= 0).all()
    for trajectory in (0, 17, 59):
        run = carom.run(name, trajectory=trajectory, t_max=15)
        assert same(rows[rows["trajectory"] == trajectory], run.hits)
    alone = numpy.concatenate(list(carom.hits(name, block=33, threads=1, **ensemble)))
    assert same(alone, rows)


@pytest.mark.parametrize("name, t_max", [
    ("stadium", 30), ("lorentz-triangular", 10), ("magnetic-square", 50), ("three-disc", 10), ("soft-lorentz", 3), (DISCS, 5),
])  # fmt: skip
def test_trajectories_are_those_of_the_ensemble(name, t_max):
    keywords = {"trajectories": 400 if name not in ("soft-lorentz", DISCS) else 40, "t_max": t_max}
    result = carom.escape(name, per_trajectory=True, **keywords)
    blocks = list(carom.trajectories(name, block=150, **keywords))
    assert [len(rows) for rows in blocks[:-1]] == [150] * (len(blocks) - 1)
    rows = numpy.concatenate(blocks)
    assert same(rows, result.per_trajectory)
    assert same(numpy.concatenate(list(carom.trajectories(name, threads=1, **keywords))), rows)


@pytest.mark.parametrize("name", ["lorentz-triangular", "stadium", "soft-lorentz", "ellipse-magnetic"])
def test_survivors_end_where_their_runs_do(name):
    (rows,) = carom.trajectories(name, trajectories=20, t_max=3)
    survived = rows[rows["fate"] == carom.fates.index("survived")]
    assert len(survived) > 5
    for row in survived[:5]:
        run = carom.run(name, trajectory=int(row["index"]), t_max=3)
        assert (row["end_x"], row["end_y"], row["end_vx"], row["end_vy"]) == (run.x, run.y, run.vx, run.vy)
        assert row["end_wall"] == (run.hits["wall"][-1] if len(run.hits) else row["wall"])


def test_a_function_gets_the_hits_of_a_run():
    got = []
    run = carom.run("stadium", collisions=200_000, on_hit=got.append)
    assert same(numpy.concatenate(got), run.hits) and len(got) < 2000
    assert run.x == carom.run("stadium", collisions=200_000).x


def test_an_error_of_the_function_stops_the_run():
    def fail(rows):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as stopped:
        carom.run("sinai", collisions=10**8, on_hit=fail)
    assert 0 < stopped.value.result.collisions < 10**8
    with pytest.raises(RuntimeError, match="enough"):
        carom.run("sinai", collisions=1, on_hit=fail)


def test_leaving_a_loop_ends_the_computation():
    begin = time.monotonic()
    threads = threading.active_count()
    for rows in carom.hits("sinai", collisions=10**10):
        break
    for rows in carom.trajectories("sinai", trajectories=10**9, t_max=100):
        assert len(rows) == 10_000
        break
    del rows
    assert time.monotonic() - begin < 20 and threading.active_count() == threads


@pytest.mark.parametrize("take", [
    lambda: carom.hits("sinai", collisions=10**10), lambda: carom.hits("sinai", trajectories=10**8, t_max=100),
    lambda: carom.trajectories("sinai", trajectories=10**9, t_max=100),
])  # fmt: skip
def test_ctrl_c_ends_the_loop(take):
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in take():
            pass
    timer.join()


def test_memory_is_bounded():
    with open("/proc/self/statm", encoding="ascii") as stream:
        before = int(stream.read().split()[1])
    total = 0
    for rows in carom.hits("stadium", trajectories=3, collisions=3_000_000, t_max=10**7, block=50_000, threads=1):
        total += len(rows)
        if total > 2_000_000:
            break
    with open("/proc/self/statm", encoding="ascii") as stream:
        after = int(stream.read().split()[1])
    assert (after - before) * os.sysconf("SC_PAGE_SIZE") < 2**30


@pytest.mark.parametrize("call, message", [
    (lambda: carom.hits("stadium", block=0), "'block' is 0"),
    (lambda: carom.hits("stadium", collisions=5, precision="certified"), "carom.hits has no keyword 'precision'"),
    (lambda: carom.trajectories("stadium", sweep={"B": [1]}), "carom.trajectories has no keyword 'sweep'"),
    (lambda: carom.run("stadium", on_hit=5), "'on_hit' is 5"),
    (lambda: carom.run("stadium", on_hit=print, collisions=2, digits=20), "on_hit does not go with"),
    (lambda: next(carom.hits("stadium", position=(9, 9), velocity=(1, 0), collisions=5)), "is not inside"),
])  # fmt: skip
def test_what_makes_no_sense_is_bad_input(call, message):
    with pytest.raises(carom.InputError, match=message):
        call()
