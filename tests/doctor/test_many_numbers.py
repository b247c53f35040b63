"""Long formulas in which a name is typed as its number are right, however many numbers they hold."""

from __future__ import annotations

import re

import pytest
import sympy

import kinlab as kl
from kinlab import symbolic
from kinlab.doctor.file import examine_file


@pytest.fixture(scope="module")
def energy() -> str:
    arm = symbolic.arm(kl.load("spatial3r").table)
    return str(sympy.expand(symbolic.kinetic_energy(arm)))


@pytest.mark.parametrize(("name", "number"), [("m3", "1.20"), ("m2", "2.0"), ("a1", "0.45")])
def test_a_name_as_its_number_is_no_slip(tmp_path, energy, name, number):
    file = tmp_path / "energy.toml"
    text = re.sub(rf"\b{name}\b", number, energy)
    file.write_text(f'robot = "spatial3r"\n[formulas]\nkinetic_energy = "{text}"\n')
    (found,) = examine_file(file, samples=30)
    assert found.agrees, str(found)
    assert f"it holds only for {name} = " in str(found)


def test_one_of_many_places_typed_as_a_number_is_no_slip(tmp_path, energy):
    file = tmp_path / "energy.toml"
    text = re.sub(r"\bm3\b", "1.2", energy, count=20)
    assert "m3" in text
    file.write_text(f'robot = "spatial3r"\n[formulas]\nkinetic_energy = "{text}"\n')
    (found,) = examine_file(file, samples=30)
    assert found.agrees, str(found)


def test_a_lost_sign_beside_many_numbers_is_a_slip(tmp_path, energy):
    file = tmp_path / "energy.toml"
    text = re.sub(r"\bm3\b", "1.2", energy).replace("+ Izz3*qd3**2/2", "- Izz3*qd3**2/2")
    file.write_text(f'robot = "spatial3r"\n[formulas]\nkinetic_energy = "{text}"\n')
    (found,) = examine_file(file, samples=30)
    assert not found.agrees
