"""Equilibria as Python objects."""

import numpy
import pytest

import carom


@pytest.fixture(scope="module")
def molecule():
    return carom.relax("wigner", starts=20, threads=1)


def test_equilibria_are_records(molecule):
    ground = molecule.equilibria[0]
    assert ground.energy / 5 == pytest.approx(2.3384453805, abs=1e-10)
    assert ground.kind == "minimum"
    assert numpy.array(ground.positions).shape == (5, 2)
    assert len(ground.frequencies) == 10
    assert "minimum" in str(molecule)


def test_archives_keep_them(molecule, tmp_path):
    molecule.save(tmp_path / "a.h5")
    again = carom.open(tmp_path / "a.h5")
    assert isinstance(again, carom.Equilibria)
    for key in ("energy", "energy_error", "position_error", "positions", "frequencies", "found"):
        assert again.equilibria[0][key] == molecule.equilibria[0][key]


def test_they_have_a_picture(molecule):
    panels = molecule.plot()
    assert len(panels) == len(molecule.equilibria)
    for ax, one in zip(panels, molecule.equilibria):
        assert any(line.get_xydata().tolist() == one.positions for line in ax.lines)


def test_what_does_not_act_is_refused():
    with pytest.raises(carom.InputError):
        carom.relax("stadium")
