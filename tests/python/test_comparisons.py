"""Integrators compared, in Python."""

import math

import matplotlib.pyplot as pyplot
import numpy
import pytest

import carom


@pytest.fixture(scope="module")
def compared():
    return carom.compare("henon-heiles", t_max=4, schemes=["velocity-verlet", "suzuki-4", "cvode"])


def test_rows_are_runs(compared):
    rows = compared.schemes
    assert set(rows["scheme"]) == {"velocity-verlet", "suzuki-4", "cvode"}
    assert numpy.isnan(rows["step"]).any() and numpy.isnan(rows["tolerance"]).any()
    verlet = rows[rows["scheme"] == "velocity-verlet"]
    assert (numpy.diff(verlet["step"]) < 0).all() and (numpy.diff(verlet["force_evaluations"]) > 0).all()
    orders = {row["scheme"]: row for row in compared.measured}
    for name, order in (("velocity-verlet", 2), ("suzuki-4", 4)):
        assert abs(orders[name]["order"] - order) <= max(orders[name]["order_error"], 0.02)
    assert math.isnan(orders["cvode"]["stated"])


def test_an_archive_is_the_same_result(compared, tmp_path):
    compared.save(tmp_path / "a.h5")
    again = carom.open(tmp_path / "a.h5")
    assert isinstance(again, carom.Comparison)
    assert again.json == compared.json


def test_the_picture_has_a_line_a_scheme(compared):
    axes = compared.plot()
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["velocity-verlet", "suzuki-4", "cvode", "error wanted", "error of the reference"]
    pyplot.close("all")


def test_steps_and_bad_names_are_passed_on():
    few = carom.compare("henon-heiles", t_max=2, schemes="ruth-3", steps=[0.1, 0.05])
    assert list(few.schemes["step"]) == [0.1, 0.05]
    with pytest.raises(carom.InputError) as error:
        carom.compare("henon-heiles", schemes=["ruth-4"])
    assert error.value.nearest == "ruth-3"


def test_schemes_are_a_table():
    rows = carom.schemes()
    assert "velocity-verlet" in rows["name"]
    assert numpy.isnan(rows["order"][rows["name"] == "cvode"]).all()
