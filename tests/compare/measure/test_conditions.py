"""Vibrissae that a method takes for the paper's."""

from dataclasses import replace

import pytest

from analytic import Beam, Case, named_case
from compare.measure.conditions import CONDITIONS

CASE = Case(Beam(0.05, 2e-6, 2.5e-4), named_case("parabola").profile.scaled(0.05))


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("exact", CASE),
        ("curved", replace(CASE, beam=replace(CASE.beam, natural_curvature=-4.0))),
        ("tapered", replace(CASE, beam=replace(CASE.beam, tip_radius=2e-4))),
        ("soft-clamp", replace(CASE, clamp_stiffness=4e-4)),
        ("friction", replace(CASE, friction=0.2)),
    ],
)
def test_each_is_as_large_as_it_says_in_any_units(name, changed):
    true = CONDITIONS[name].true(CASE)
    assert true.beam.natural_curvature == pytest.approx(changed.beam.natural_curvature, rel=1e-12)
    assert true.beam.radius_at(0.05) == pytest.approx(changed.beam.radius_at(0.05), rel=1e-12)
    assert true.clamp_stiffness == pytest.approx(changed.clamp_stiffness, rel=1e-12)
    assert true.friction == changed.friction
    # It is as large in a case that is of such a vibrissa already.
    again = CONDITIONS[name].true(true)
    assert again.beam.natural_curvature == pytest.approx(true.beam.natural_curvature, rel=1e-12)
    assert again.friction == true.friction
