"""Texts, arguments and archives of strangers: pictures and errors stay what they are."""

import json
import os
import pathlib
import signal
import subprocess
import time

import numpy
import pytest

import carom


def titled(title):
    return carom.System(f'title = {json.dumps(title)}\n[table]\nshape = "circle"\nradius = 1\n', "circle")


HOSTILE = ["$$", "$x^2$", r"$\frac{$", "\x1b]0;owned\x07 \x9b31m \u202e", r"\$ 50 % & #", "a\nb"]


@pytest.mark.parametrize("title", HOSTILE)
@pytest.mark.parametrize("ending", ["svg", "png"])
def test_a_title_is_no_formula(title, ending, tmp_path):
    pytest.importorskip("matplotlib").use("Agg")
    system = titled(title)
    file = tmp_path / f"a.{ending}"
    system.plot().figure.savefig(file)
    carom.escape(system.hole("circle", 0, 0.3), trajectories=50, t_max=5).plot().figure.savefig(file)
    if ending == "svg":
        import xml.dom.minidom

        xml.dom.minidom.parse(str(file))


@pytest.mark.parametrize("name", ["$$", r"$\frac{$", "_x$"])
def test_names_of_holes_and_walls_are_no_formulas(name, tmp_path):
    pytest.importorskip("matplotlib").use("Agg")
    system = carom.circle().hole("circle", 0, 1, name=name)
    system.plot().figure.savefig(tmp_path / "a.svg")
    result = carom.escape(system, trajectories=50, t_max=5, per_trajectory=True)
    carom.plot.basins(result, colour="hole").figure.savefig(tmp_path / "b.svg")
    pieces = [{"line_to": [1, 0], "name": name}, {"line_to": [0, 1]}, {"line_to": [0, 0]}]
    walls = carom.path({"start": [0, 0], "pieces": pieces})
    carom.section(walls, orbits=1, points=5).plot().figure.savefig(tmp_path / "c.svg")


def test_printed_texts_do_not_act():
    system = titled("a\x1b[31m\u202e")
    for shown in (str(carom.table(system)), repr(carom.table(system)), repr(system), system._repr_svg_()):
        assert not any(c in shown for c in "\x1b\u202e")
    with pytest.raises(carom.InputError) as raised:
        carom.system("\x1b[31m")
    assert "\x1b" not in str(raised.value)


HALF = "\ud800"
WRONG = {
    "a half of a character": [
        lambda: carom.system(HALF), lambda: carom.load(HALF), lambda: carom.open(HALF),
        lambda: carom.run("circle", title=HALF), lambda: carom.run("circle", engine=HALF),
        lambda: carom.run("circle", **{HALF: 1}), lambda: carom.circle().hole("circle", 0, 1, name=HALF),
        lambda: carom.escape("circle", sweep={HALF: [1]}), lambda: carom.escape("circle", sweep={"field.B": HALF}),
        lambda: carom.circle().obstacle("circle", **{HALF: 1}), lambda: carom.run("circle", initial={HALF: 1}),
        lambda: carom.run("circle", t_max=1).save(HALF), lambda: carom.plot.result(carom.circle(), what=HALF),
    ],
    "an array as a word": [
        lambda: carom.system(numpy.array(["circle", "stadium"])), lambda: carom.run(numpy.array([1.0, 2.0])),
        lambda: carom.run("circle", precision=numpy.array(["double", "certified"])),
        lambda: carom.run("circle", engine=numpy.array(["auto", "steps"])),
        lambda: carom.run("circle", title=numpy.array([1, 2])), lambda: carom.load(numpy.array(["a"])),
        lambda: carom.open(numpy.array(["a", "b"])), lambda: carom.circle().hole(numpy.arange(3), 0, 1),
        lambda: carom.plot.result(carom.circle(), what=numpy.array(["table", "x"])),
        lambda: carom.run("circle", threads=numpy.array([1, 2])),
        lambda: carom.escape("circle", per_trajectory=numpy.array([1, 0])),
        lambda: carom.escape("circle", splitting=numpy.array([[1, 2], [3, 4]])),
    ],
    "no mapping": [
        lambda: carom.run("circle", initial=5), lambda: carom.run("circle", initial=[1, 2]),
        lambda: carom.path(5), lambda: carom.path(["a"]), lambda: carom.run("circle", table=3),
        lambda: carom.run("circle", potential=3), lambda: carom.escape("circle", sweep=[1, 2]),
        lambda: carom.run("circle", integrator="x"), lambda: carom.run("circle", initial={1: 2}),
        lambda: carom.run("circle", particles=[1]), lambda: carom.run("circle", times={"from": {}}),
        lambda: carom.polygon(5), lambda: carom.polygon({"a": 1}), lambda: carom.discs(None),
        lambda: carom.run("circle", title=object()), lambda: carom.open(None), lambda: carom.load(3),
        lambda: carom.open("a\0b"), lambda: carom.load("a\0b"), lambda: carom.system(None),
    ],
}  # fmt: skip


@pytest.mark.parametrize("kind, index", [(kind, i) for kind, calls in WRONG.items() for i in range(len(calls))])
def test_wrong_arguments_are_input_errors(kind, index):
    with pytest.raises(carom.InputError) as raised:
        WRONG[kind][index]()
    assert any(raised.value.place) or raised.value.expected


def test_nested_lists_have_a_limit():
    deep = []
    for _ in range(5000):
        deep = [deep]
    with pytest.raises(carom.InputError):
        carom.run("circle", times=deep)


def test_a_file_that_is_no_text_has_a_place(tmp_path):
    file = tmp_path / "a.toml"
    file.write_bytes(b"[table]\nshape = \"\xff\"\n")
    with pytest.raises(carom.InputError) as raised:
        carom.load(file)
    assert raised.value.place.file == str(file)


# Archives.


def test_rows_are_read_when_they_are_asked_for(tmp_path):
    file = tmp_path / "a.h5"
    run = carom.run(carom.circle(), t_max=50)
    run.save(file)
    opened, late = carom.open(file), carom.open(file)
    assert (opened.hits == run.hits).all()
    time.sleep(0.02)
    carom.run(carom.circle(), t_max=60).save(file, force=True)
    assert (opened.hits == run.hits).all()
    with pytest.raises(carom.InputError, match="changed since it was opened"):
        late.hits


def forged(tmp_path, change):
    """An archive that was changed and has the right checksums."""
    import binascii

    import h5py

    file = tmp_path / "a.h5"
    carom.run(carom.circle(), t_max=50).save(file)
    with h5py.File(file, "r+") as archive:
        change(archive)
        lines = []

        def line(path, data, kind):
            if kind is None:
                raw = b"".join((t if isinstance(t, bytes) else t.encode()) + b"\0" for t in numpy.ravel(data))
                kind, count = "text", numpy.size(data)
            else:
                raw, count = data.tobytes(), data.size
            lines.append(f"{binascii.crc32(raw):08x} {kind} {count:015d} {path}\n")

        def kind_of(thing):
            return thing.dtype.name if thing.dtype.kind in "iuf" else None

        def visit(path, thing):
            if isinstance(thing, h5py.Dataset):
                line(path, numpy.asarray(thing[()]), kind_of(thing))
            for name in thing.attrs:
                if path + "@" + name != "/provenance@checksums":
                    value = numpy.asarray(thing.attrs[name])
                    line(f"{path}@{name}", value, value.dtype.name if value.dtype.kind in "iuf" else None)

        visit("/", archive)
        archive.visititems(lambda path, thing: visit("/" + path, thing))
        text = "".join(lines).encode()
        text = f"{binascii.crc32(text):08x}\n".encode() + text
        del archive["provenance"].attrs["checksums"]
        archive["provenance"].attrs.create("checksums", numpy.bytes_(text))
    return file


def test_forging_without_a_change_is_read(tmp_path):
    pytest.importorskip("h5py")
    assert len(carom.open(forged(tmp_path, lambda archive: None)).hits) > 10


def resized(archive, path, size):
    archive[path].resize((size,))


def retyped(archive, path, values):
    del archive[path]
    archive[path] = values


FORGERIES = {
    # 78 kB that stated 2^26 rows took 6.2 GB.
    "fill rows": lambda archive: [resized(archive, f"collisions/{name}", 1 << 22) for name in archive["collisions"]],
    "a short column": lambda archive: retyped(archive, "state/u", numpy.zeros(0)),
    "no state": lambda archive: [retyped(archive, f"state/{name}", numpy.zeros(0)) for name in archive["state"]],
    "no group": lambda archive: archive.__delitem__("state"),
    "a wall beyond": lambda archive: archive["state/wall"].write_direct(numpy.array([99])),
    "no number": lambda archive: archive["state/vx"].write_direct(numpy.array([numpy.nan])),
    "an unknown fate": lambda archive: archive["state/fate"].write_direct(numpy.array([77])),
    "a system that is none": lambda archive: retyped(archive, "system", "x = ["),
    "hits of unequal lengths": lambda archive: resized(archive, "collisions/x", 3),
    "an end without an end": lambda archive: archive["state/end_high"].write_direct(numpy.array([1e300])),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_forged_archives_are_input_errors(name, tmp_path):
    pytest.importorskip("h5py")
    file = forged(tmp_path, FORGERIES[name])
    with pytest.raises(carom.InputError) as raised:
        carom.open(file).hits
    assert str(file) in (raised.value.place.file + str(raised.value))


# The program's pictures.


def program(*arguments, cwd, **how):
    return subprocess.Popen(
        [os.environ["CAROM_PROGRAM"], *map(str, arguments)], cwd=cwd, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, **how,
    )  # fmt: skip


def descendants(pid):
    children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in children]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
@pytest.mark.parametrize("wait", [0.1, 2.5])
def test_a_signal_ends_the_film_and_its_python(number, wait, tmp_path):
    film = program("animate", "wigner", "-o", "y.gif", cwd=tmp_path)
    while not (children := descendants(film.pid)):
        time.sleep(0.01)
    time.sleep(wait)
    film.send_signal(number)
    out, said = film.communicate(timeout=20)
    assert film.returncode == 130 and "Traceback" not in said
    assert list(tmp_path.iterdir()) == []
    for child in children:
        assert not pathlib.Path(f"/proc/{child}").exists()


def test_json_says_what_was_drawn(tmp_path):
    for command, file, kind in (("plot", "a.png", "picture"), ("animate", "a.gif", "film")):
        few = ("--frames", 4) if kind == "film" else ()
        done = program(command, "circle", "-o", file, "--json", *few, cwd=tmp_path)
        said = json.loads(done.communicate()[0])
        assert (said["file"], said["kind"], said["system"]) == (file, kind, "circle")
        assert done.returncode == 0 and (tmp_path / file).exists()


@pytest.mark.parametrize("what", ["-1/2", "--help", "-x"])
def test_what_is_asked_for_is_the_programs_own(what, tmp_path):
    done = program("plot", "circle", f"--what={what}", "-o", "a.png", cwd=tmp_path)
    _, said = done.communicate()
    assert done.returncode == 1 and f"has no picture '{what}'" in said and "usage:" not in said
    assert said.startswith("carom: ") and list(tmp_path.iterdir()) == []


def test_pictures_follow_no_link_that_was_planted(tmp_path):
    (tmp_path / "precious").write_text("precious")
    (tmp_path / "a.part.png").symlink_to("precious")
    done = program("plot", "circle", "-o", "a.png", cwd=tmp_path)
    assert done.wait() == 0 and (tmp_path / "precious").read_text() == "precious"
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
