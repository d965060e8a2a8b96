"""What a start loads."""

import os
import pathlib
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc is Linux's")

PYTHON = os.environ.get("CAROM_PYTHON", sys.executable)  # which an emulator may run
BEGIN = """
import carom
def loaded():
    return {line.split()[-1] for line in open("/proc/self/maps") if "flint" in line}
def certified():
    return carom.run("circle", precision="certified", digits=30)
"""
OPENED = """
carom.escape("stadium", trajectories=100)
print(len(loaded()))
certified()
print(*loaded())
"""
MISSED = """
try:
    certified()
except RuntimeError as error:
    print("need FLINT" in str(error))
print(carom.escape("stadium", trajectories=100).trajectories)
"""


def words_of(script, **environment):
    return subprocess.run(
        [PYTHON, "-c", BEGIN + script],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
    ).stdout.split()


def test_flint_is_opened_by_certified_runs_alone():
    before, *after = words_of(OPENED)
    assert before == "0" and after


def test_flint_is_missed_by_name(tmp_path):
    for file in words_of(OPENED)[1:]:  # what is no library is found first
        name, _, version = pathlib.Path(file).name.partition(".so.")
        version = version.split(".")
        for length in range(len(version) + 1):
            (tmp_path / ".".join([name + ".so", *version[:length]])).touch()
    assert words_of(MISSED, LD_LIBRARY_PATH=str(tmp_path)) == ["True", "100"]
