"""The table ``[uncertainty]`` of a case file."""

import math

import pytest

from tests.compare.case_files import POST, WIRE

IN_UNITS = f"\n{WIRE}{POST}"
PLAIN = '[profile]\nkind = "catenary"\na = 0.5\nc = -0.8\n'

TABLE = "[uncertainty]\n"


def test_units_and_shares_become_numbers_of_the_case(load):
    found = load(
        IN_UNITS + TABLE + 'flexural_rigidity = { standard = "2 %" }\n'
        'length = { within = "0.1 mm" }\n'
        'foot_x = { standard = "50 um" }\n'
        "friction = { within = 0.02 }\n"
        'gain_moment_z = { standard = "1 %" }\n'
        'correlations = [["flexural_rigidity", "foot_x", 0.5]]\n'
        '[uncertainty.noise]\nforce_x = "0.2 mN"\n',
    ).uncertainties
    sizes = {name: one.standard for name, one in found.inputs.items()}
    assert sizes == pytest.approx(
        {
            "flexural_rigidity": 4e-8,
            "length": 1e-4 / math.sqrt(3),
            "foot_x": 5e-5,
            "friction": 0.02 / math.sqrt(3),
            "gain_moment_z": 0.01,
        }
    )
    assert found.inputs["length"].distribution == "uniform"
    assert found.noise == pytest.approx({"force_x": 2e-4})
    assert found.correlation[0, 2] == 0.5


def test_plain_numbers_are_in_the_units_of_the_case(load):
    stated = 'length = { standard = 1e-3 }\nradius = { standard = "4 %" }'
    found = load(PLAIN + TABLE + stated).uncertainties
    assert found.inputs["length"].standard == 1e-3
    assert found.inputs["radius"].standard == pytest.approx(0.04 * 0.005)
    assert load(PLAIN).uncertainties is None


@pytest.mark.parametrize(
    ("table", "why"),
    [
        ('length = "0.1 mm"', "uncertainty.length = '0.1 mm': must be a table"),
        ('length = { standard = "1 mm", within = "1 mm" }', "say which of the two it is"),
        ("length = { standard = 0.1 }", "with a unit of m"),
        ('length = { standard = "-1 mm" }', "from 0 up"),
        ('foot_x = { standard = "2 %" }', "with a unit of m"),
        ('friction = { standard = "0.1 N" }', "a plain number"),
        ('tip_radius = { standard = "1 um" }', "has no tip_radius"),
        ('lenght = { standard = "1 mm" }', "line 11: uncertainty.lenght"),
        ('noise = { force_z = "1 mN" }', "must be a reading, one of force_x"),
        ('noise = { force_x = "2 %" }', "with a unit of N"),
        ('correlations = [["length", "radius"]]', "correlations.0.2 = missing"),
        ('correlations = [["length", "radius", 0.5]]', "those are none"),
    ],
)
def test_what_cannot_be_is_one_line(refused, table, why):
    said = refused(f"{IN_UNITS}{TABLE}{table}\n")
    assert why in said
    assert "uncertainty" in said
