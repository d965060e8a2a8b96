"""What tests of the module share: the program to compare with, and pictures without a screen."""

import json
import os
import subprocess

import matplotlib
import pytest

matplotlib.use("Agg")


@pytest.fixture
def program():
    """Runs the program and reads what it prints as JSON."""

    def run(*arguments):
        command = [os.environ["CAROM_PROGRAM"], *map(str, arguments), "--json", "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode in (0, 3), done.stderr
        return json.loads(done.stdout)

    return run
