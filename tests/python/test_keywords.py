"""Keywords mean what the options of the program mean; the others are refused."""

import os
import re
import subprocess

import numpy
import pytest

import carom

FUNCTIONS = {
    "escape": carom.escape, "diffusion": carom.diffusion, "lyapunov": carom.lyapunov, "run": carom.run,
    "section": carom.section, "relax": carom.relax, "compare": carom.compare, "orbit": carom.orbits,
    "table": carom.table,
}  # fmt: skip
# Files, prints and processes of the program; sections are keywords of their own.
NO_KEYWORDS = set(
    "help json quiet verbose output force set closed resume checkpoint shard block".split()
)


def options_of(command):
    """The options that the program's help names."""
    help_ = subprocess.run(
        [os.environ["CAROM_PROGRAM"], command, "--help"], capture_output=True, text=True, check=True
    ).stdout
    names = re.findall(r"^  (?:-\w,)?\s*--([a-z-]+)", help_, re.M)
    return {name.replace("-", "_") for name in names} - NO_KEYWORDS


@pytest.fixture(scope="module")
def options():
    return {command: options_of(command) for command in FUNCTIONS}


@pytest.mark.parametrize("command", FUNCTIONS)
def test_options_of_other_commands_are_refused(command, options):
    others = set.union(*options.values()) - options[command]
    assert {"tries", "splitting", "schemes", "saddles"} & others
    name = FUNCTIONS[command].__name__
    for key in sorted(others):
        with pytest.raises(carom.InputError, match=f"^'{key}' means nothing to carom.{name}: it is a keyword of "):
            FUNCTIONS[command]("stadium", **{key: 5})


@pytest.mark.parametrize("command", FUNCTIONS)
def test_options_of_a_command_are_its_keywords(command, options):
    for key in sorted(options[command]):
        try:
            FUNCTIONS[command]("stadium", **{key: object()})
        except carom.InputError as error:
            assert "means nothing" not in str(error) and "has no keyword" not in str(error), key
            assert key in str(error), key
        else:
            raise AssertionError(key)


@pytest.mark.parametrize("key", sorted(NO_KEYWORDS - {"help"}))
def test_what_only_the_program_does_is_no_keyword(key):
    with pytest.raises(carom.InputError, match=f"carom.escape has no keyword '{key}'"):
        carom.escape("stadium", **{key: 1})


@pytest.mark.parametrize(
    "call, message, nearest",
    [
        (lambda: carom.escape("stadium", trajectorys=5),
         "carom.escape has no keyword 'trajectorys'; did you mean 'trajectories'?", "trajectories"),
        (lambda: carom.run("stadium", trajectori=5),
         "carom.run has no keyword 'trajectori'; did you mean 'trajectory'?", "trajectory"),
        (lambda: carom.escape("stadium", tries=5),
         "'tries' means nothing to carom.escape: it is a keyword of carom.orbits; did you mean 'times'?", "times"),
        (lambda: carom.system("stadium").with_(hits=5),
         "'hits' means nothing to a system: it is a keyword of carom.orbits", ""),
        (lambda: carom.system("stadium").with_(t_maxx=5), "a system has no keyword 't_maxx'; did you mean 't_max'?",
         "t_max"),
    ],
)  # fmt: skip
def test_messages_name_keyword_command_and_nearest_name(call, message, nearest):
    with pytest.raises(carom.InputError) as caught:
        call()
    assert str(caught.value) == message
    assert caught.value.nearest == nearest and caught.value.place.key in message


def test_a_system_holds_what_some_commands_use(program):
    held = carom.system("stadium").with_(
        trajectories=50, t_max=5, seed=3, threads=1, trajectory=2, points=7, orbits=2, times=[1, 5]
    )
    escape = carom.escape(held)
    assert escape.trajectories == 50 and len(escape.survival) == 2 and escape.json["threads"] == 1
    printed = program("escape", "stadium", "--trajectories", 50, "--t-max", 5, "--seed", 3, "--times", "1,5")
    assert escape.digest == printed["digest"]
    printed = program("run", "stadium", "--trajectory", 2, "--t-max", 5, "--seed", 3)
    assert carom.run(held).json["x"] == printed["x"]
    assert carom.section(held).orbits == 2
    assert carom.section(held, t_max=1000).points["index"].max() == 6
    assert carom.orbits(held, hits=2, starts=20).json["seed"] == 3
    assert "points = 7" in held.to_toml() and "trajectories = 50" in held.to_toml()
    assert carom.relax(carom.system("soft-lorentz").with_(t_max=5, isa="baseline"), starts=2).starts == 2


def test_a_result_keeps_what_describes_its_system():
    found = carom.orbits("three-disc", hits=2, seed=5, digits=5, certify=True)
    assert isinstance(carom.run(found.system), carom.Run)  # its digits were those of the orbits
    assert carom.run(found.system).json["seed"] == 5
    run = carom.run("stadium", trajectory=3, t_max=5)
    assert carom.run(run.system).json["x"] == run.json["x"]


@pytest.mark.parametrize("key, given", [
    ("times", []), ("times", ""), ("trajectories", ""), ("splitting", []), ("window", ()),
])  # fmt: skip
def test_an_option_needs_a_value(key, given):
    with pytest.raises(carom.InputError, match=f"'{key}' needs a value"):
        carom.escape("stadium", **{key: given})


def test_lists_numbers_and_text_are_the_same():
    T = {"trajectories": 20, "t_max": 5}
    digests = {carom.escape("stadium", times=times, **T).digest for times in ([5], 5, "5", numpy.array([5]))}
    assert len(digests) == 1
    start = {"velocity": "3/5,4/5", "t_max": 5}
    text = carom.run("stadium", position="1/10,1/5", **start)
    assert text.json["x"] == carom.run("stadium", position=("1/10", "1/5"), **start).json["x"]
    times = {"from": 1, "to": 4, "count": 4, "spacing": "linear"}
    assert list(carom.escape("stadium", times=times, **T).survival["t"]) == [1, 2, 3, 4]
    assert carom.run("stadium", collisions=3, digits=None, precision=None).collisions == 3


@pytest.mark.parametrize("call, message", [
    (lambda: carom.run("stadium", engine="event", collisions=5), "'event' is not an engine"),
    (lambda: carom.run("stadium", position=1, collisions=5), "not a pair"),
    (lambda: carom.orbits("stadium", certify="yes"), "'certify' is 'yes'"),
    (lambda: carom.circle(radius=object()), "'radius' cannot be <object"),
    (lambda: carom.escape("stadium", field={"B": None}), "'field' cannot be None"),
    (lambda: carom.escape(None), "None is not a system"),
    (lambda: carom.escape("stadium", trajectories=5, progress="no"), "'progress' is 'no'"),
    (lambda: carom.validate(scale=None), "'scale' cannot be None"),
    (lambda: carom.run("stadium", collisions=3).path(1), "there is no particle 1"),
])  # fmt: skip
def test_bad_values_are_bad_input(call, message):
    with pytest.raises(carom.InputError, match=message):
        call()


@pytest.mark.parametrize("sweep, message", [
    ({}, "a sweep has keys and their values, not {}"),
    ([], "a sweep has keys and their values"),
    ("field.B=1", "a sweep has keys and their values"),
    ({1: [1]}, "1 is not a key of a system"),
    ({"field.B": []}, "'field.B' has no values in"),
    ({"B": numpy.array([])}, "'B' has no values in"),
    ({"B": None}, "'B' has no values in None"),
    ({"B": [[1, 2], [3, 4]]}, "'B' has no values in"),
    ({"B": [1, object()]}, "'B' cannot be <object"),
    ({"B": ""}, "cannot read the values"),
    ({"B": [1], "points": [1]}, "it means nothing to carom escape"),
    ({"t_max": [1, 2]}, "--t-max also sets it"),
    ({"integrator.step": [1, 2]}, "no force acts"),
    ({"table.radius": [1, -1]}, "--sweep: table.radius = -1"),
])  # fmt: skip
def test_bad_sweeps_are_refused(sweep, message):
    with pytest.raises(carom.InputError, match=message):
        carom.escape("stadium", trajectories=10, t_max=5, sweep=sweep)


def test_a_sweep_takes_the_place_of_what_the_system_holds():
    held = carom.system("stadium").with_(t_max=1, B=3, trajectories=10)
    swept = carom.escape(held, sweep={"t_max": [5, 10], "B": [0, "1/2"]})
    assert list(swept.table["run.t_max"]) == [5, 5, 10, 10]
    for result, (t, B) in zip(swept.results, [(5, 0), (5, "1/2"), (10, 0), (10, "1/2")]):
        assert result.digest == carom.escape("stadium", trajectories=10, t_max=t, B=B).digest
    one = carom.escape(held, sweep={"B": 0.5})
    assert len(one) == 1 and one[0].digest == carom.escape(held, B=0.5).digest


def test_the_table_of_a_sweep_says_which_rows_are_doubted():
    swept = carom.diffusion("lorentz-triangular", trajectories=300, t_max=50, sweep={"B": [0, 3]})
    assert list(swept.table["note"]) == ["", swept[1].json["note"]]
    assert "D does not exist" in swept.table["note"][1]


def test_an_archive_of_a_sweep_keeps_its_options(program, tmp_path):
    """The program goes on with it: it needs the options that are no keys of a system."""
    h5py = pytest.importorskip("h5py")
    made, printed = tmp_path / "made.h5", tmp_path / "printed.h5"
    steps = {"engine": "steps", "integrator": {"step": "1/100"}, "trajectories": 5, "t_max": 2}
    carom.escape("stadium", sweep={"B": [0, 1]}, per_trajectory=True, **steps).save(made)
    program("escape", "stadium", "--sweep", "field.B=list:0,1", "--per-trajectory", "--engine", "steps", "--set",
            "integrator.step=1/100", "--trajectories", 5, "--t-max", 2, "-o", printed)  # fmt: skip

    def options(file):
        with h5py.File(file) as archive:
            return list(archive["sweep"].attrs["options"])

    assert options(made) == options(printed) and len(options(made)) >= 2


def _without_title(system):
    return system.to_toml().split("\n", 1)[1]


def test_a_sweep_takes_the_place_of_what_its_call_gives():
    call = {"t_max": 5, "integrator": {"scheme": "velocity-verlet", "step": 0.01}}
    swept = carom.run("henon-heiles", sweep={"integrator.step": [0.1, 0.5]}, **call)
    for result, step in zip(swept.results, (0.1, 0.5)):
        call["integrator"]["step"] = step
        alone = carom.run("henon-heiles", **call)
        assert (result.x, result.energy_error) == (alone.x, alone.energy_error)
        assert _without_title(result.system) == _without_title(alone.system)


def test_a_start_takes_the_place_of_the_one_before():
    closed = carom.stadium(half_length=1, radius=1)
    drawn = carom.run(closed, t_max=1).x
    held = closed.with_(position=(0, 0), velocity=(1, 0))
    assert carom.run(held, t_max=1).x == 1
    assert carom.run(held, initial="uniform", t_max=1).x == drawn
    again = held.with_(initial={"kind": "uniform"})
    assert carom.run(again, t_max=1).x == drawn
    assert carom.run(again, position=(0, 0), velocity=(1, 0), t_max=1).x == 1
    assert carom.run(again.with_(position=(0, 0), angle=0), t_max=1).x == 1
    with pytest.raises(carom.InputError, match="'initial' and 'position' are both given"):
        carom.run(closed, initial="uniform", position=(0, 0), t_max=1)
