"""Numbers that a calibration fits: which way they go, and in which units."""

import math

import pytest

from analytic import Beam, Case, named_case
from analytic.from_clamp.calibration.unknowns import UNKNOWNS, Sought

GIVEN = Case(Beam(0.05, 2e-6, 2.5e-4), named_case("parabola").profile.scaled(0.05))


@pytest.mark.parametrize(
    ("name", "at_first", "number", "quantity"),
    [
        ("flexural_rigidity", 1.0, 1.5, 3e-6),
        ("clamp_stiffness", 0.0, 0.1, 4e-4),
        ("natural_curvature", 0.0, -0.2, -4.0),
        ("tip_radius", 1.0, 0.8, 2e-4),
        ("friction", 0.0, 0.3, 0.3),
        ("offset", 0.0, 0.02, 1e-3),
    ],
)
def test_each_is_a_plain_number_of_a_quantity_with_a_unit(name, at_first, number, quantity):
    unknown = UNKNOWNS[name]
    assert unknown.now(Sought(GIVEN), GIVEN) == pytest.approx(at_first)
    tried = unknown.tried(Sought(GIVEN), GIVEN, number)
    assert unknown.now(tried, GIVEN) == pytest.approx(number, rel=1e-12)
    assert unknown.value(tried) == pytest.approx(quantity, rel=1e-12)
    # Nothing else of it is another.
    for other in UNKNOWNS:
        if other not in (name, "flexural_rigidity", "clamp_stiffness"):
            kept = UNKNOWNS[other].now(tried, GIVEN)
            assert kept == pytest.approx(UNKNOWNS[other].now(Sought(GIVEN), GIVEN))


def test_what_is_rigid_or_a_cylinder_is_so_without_rounding():
    soft = UNKNOWNS["clamp_stiffness"].tried(Sought(GIVEN), GIVEN, 0.3)
    assert UNKNOWNS["clamp_stiffness"].tried(soft, GIVEN, 0.0).case.clamp_stiffness == math.inf
    cone = UNKNOWNS["tip_radius"].tried(Sought(GIVEN), GIVEN, 0.3)
    assert not UNKNOWNS["tip_radius"].tried(cone, GIVEN, 1.0).case.beam.varies
