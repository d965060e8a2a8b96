"""What a start loads."""

import subprocess
import sys

import pytest

LOADED = """
import carom
def loaded():
    return [line.split()[-1] for line in open("/proc/self/maps") if "flint" in line]
carom.escape("stadium", trajectories=100)
print(len(loaded()))
carom.run("circle", precision="certified", digits=30)
print(len(loaded()))
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/proc is Linux's")
def test_flint_is_opened_by_certified_runs_alone():
    before, after = subprocess.run(
        [sys.executable, "-c", LOADED], capture_output=True, text=True, check=True
    ).stdout.split()
    assert before == "0" and after != "0"
