"""Quantities are a number and a unit, and nothing is evaluated."""

import pytest

from analytic import InputError
from compare.read.units import in_si, unit_in_si


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("50 mm", "m", 0.05),
        ("5e1mm", "m", 0.05),
        ("-.5 m", "m", -0.5),
        ("2 N m^2", "N m^2", 2.0),
        ("2 N*m**2", "N m^2", 2.0),
        ("3 kg m^3/s^2", "N m^2", 3.0),
        ("3 kg m/(s^2 m)", "N/m", 3.0),
        ("4 1/m", "1/m", 4.0),
        ("4 m^-1", "1/m", 4.0),
    ],
)
def test_quantities(text, dimension, value):
    assert in_si(text, dimension) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    ["9**9**9 m", "m**9**9", "1 m**9**9", "((((1 m", "1 m)", '"""', "m", "5", "", "1 kg",
     "1 parsnip", "1e999 m", "nan m", "1 m" + "*m" * 1000, "1 " + "(" * 50,
     "1 m;2", "1 m\n2", "2 2 m"],
)  # fmt: skip
def test_what_is_no_quantity_is_refused_at_once(text):
    with pytest.raises(InputError) as refused:
        in_si(text, "m")
    assert len(str(refused.value)) < 300


def test_a_unit_has_no_number():
    assert unit_in_si("mN mm", "N m") == pytest.approx(1e-6)
    for unit in ("0 m", "2 m", "", "m m"):
        with pytest.raises(InputError):
            unit_in_si(unit, "m")
