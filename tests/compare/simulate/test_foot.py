"""A slide that is not across the vibrissa is a fault, what a curved one turns by is none."""

from dataclasses import replace

import pytest

from analytic import Beam, named_case
from compare.simulate.fixing import fix
from compare.simulate.inspection import Inspection
from mujoco_models import Motion, Settings, inspect_model
from mujoco_models.export.whisker import Whisker
from tests.compare.simulate.faults import faults_in, rods
from tests.mujoco_models.inspect.chains import Chain, OnRail

TURNED = "degrees from across the vibrissa"


def said_of(path):
    return " ".join(map(str, Inspection(inspect_model(path), None).faults))


@pytest.mark.parametrize("natural", [0.3, -1.0, lambda s: 2 * (1 - s) ** 3])
@pytest.mark.parametrize(
    ("beam", "segments"),
    [("chain", 20), ("chain", 40), ("chain", 80), pytest.param("rod", 40, marks=rods)],
)
def test_slide_and_sensors_of_an_exported_vibrissa_are_across_it(tmp_path, natural, beam, segments):
    """Bent most at the clamp, too: the first joint's turn counts, not that of the whole."""
    case = replace(named_case("catenary"), beam=Beam(natural_curvature=natural))
    path = tmp_path / "whisker.xml"
    path.write_text(Whisker(case, Settings(beam=beam, segments=segments), Motion(), 1.0).xml())
    assert TURNED not in said_of(path)
    assert "is turned by" not in said_of(path)


@pytest.mark.parametrize(("slope", "turned"), [(0.01, True), (-0.01, True), (5e-4, False)])
def test_the_slide_of_a_curved_vibrissa_may_not_be_turned(tmp_path, slope, turned):
    """By half a degree, of which its whole cell's turn of 0.015 would excuse all."""
    rail = OnRail.inside_foot.replace("1 0 0", f"1 {slope} 0")
    curved = OnRail(curvature=0.3, inside_foot=rail)
    assert (TURNED in said_of(curved.write(tmp_path))) == turned


@pytest.mark.parametrize("foot", ['mocap="true"', ""])
def test_hinges_that_are_turned_on_a_foot_without_a_slide_are_no_turned_sensors(tmp_path, foot):
    path = Chain(foot=foot).write(tmp_path, ('<joint axis="0 0 1"', '<joint axis="0.05 0 1"'))
    before = Inspection(inspect_model(path))
    assert "hinges are turned by 2.9 degrees about it" in said_of(path)
    assert "'F' is turned" not in said_of(path)
    after = fix(path, {}, before, tmp_path / "fixed.xml").inspection
    assert "plane" not in faults_in(after)
    assert "'F' is turned" not in " ".join(map(str, after.faults))


@pytest.mark.parametrize(("by", "turned"), [(0.02, True), (-0.02, True), (0.004, False)])
def test_the_sensors_of_a_curved_vibrissa_may_not_be_turned(tmp_path, by, turned):
    """By more than half a degree, beside a quarter of what it turns at its first joint, 0.015."""
    path = OnRail(curvature=0.3, site=f'euler="0 0 {by}"').write(tmp_path)
    assert ("'F' is turned" in said_of(path)) == turned
