"""How stiff and how thick it is along its length: a taper, a step, and few geoms that are off."""

import re

import pytest

from analytic import Beam
from compare.simulate.inspection import Inspection
from compare.simulate.rigidity import radii
from mujoco_models import inspect_model
from tests.compare.simulate.test_remarks import CONE
from tests.mujoco_models.inspect.chains import Chain, OnRail


def cone(folder, stiffer=CONE):
    path = OnRail(stiffer=stiffer).write(folder)
    text = path.read_text()
    for i in range(21):
        middle = 0.0125 if i == 0 else min(0.05 * i, 0.9875)
        name = f'name="whisker-geom{i}"'
        text = text.replace(name, f'{name} size="{0.005 * (0.98 - 0.8 * middle)}"')
    path.write_text(text)
    return path


@pytest.mark.parametrize(("tapered", "noted"), [(True, False), (False, True)])
def test_a_taper_of_ei_without_one_of_radius_is_noted(tmp_path, tapered, noted):
    found = Inspection(
        inspect_model(cone(tmp_path) if tapered else OnRail(stiffer=CONE).write(tmp_path))
    )
    if tapered:  # in steps, of which a cone has the radii at the ends
        assert radii(found.found) == pytest.approx((0.0049, 0.0009), abs=1e-9)
    (said,) = (r.text for r in found.remarks if r.subject == "uniformity")
    assert ("one that is solid would have" in said) is noted
    assert "EI goes from 0.9224 at the clamp to 0.00105 at the tip" in said  # 0.98^4 and 0.18^4


@pytest.mark.parametrize(
    ("rigidity", "faulty"), [(None, True), (1.0, True), ([[0, 1e-3], [1, 0.9]], False)]
)
def test_what_stiffens_as_it_gets_thinner_is_turned_round(tmp_path, rigidity, faulty):
    """It was a note, but for a table of EI that says so."""
    path = cone(tmp_path, {21 - i: k for i, k in CONE.items()})
    stated = None if rigidity is None else Beam(1.0, rigidity, 0.0049, tip_radius=0.0009)
    said = [r for r in Inspection(inspect_model(path), stated).remarks if "EI goes" in r.text]
    assert [r.kind for r in said] == ["fault" if faulty else "note"]
    assert ("clamp and tip are changed over" in said[0].remedy) is faulty


@pytest.mark.parametrize("thick", [(18, 19, 20), (0, 1, 2), (10,)])
def test_the_few_geoms_that_are_thicker_are_named_and_not_the_others(tmp_path, thick):
    """A thick tip, as last, was the course, and 18 of 21 thin geoms were to become as thick."""
    names = [f'name="whisker-geom{i}" ' for i in thick]
    path = Chain().write(tmp_path, *((name, f'{name}size="0.015" ') for name in names))
    found = Inspection(inspect_model(path))
    (fault,) = [fault for fault in found.faults if fault.subject == "radius"]
    assert "thicker than a straight course from 0.005 to 0.005" in str(fault)
    assert all(dict(edit.attributes)["size"].startswith("0.005 ") for edit in fault.edits)
    assert sorted(n for edit in fault.edits for n in edit.numbers) == list(thick)


def test_a_step_of_rigidity_is_one_line_and_not_one_a_joint(tmp_path):
    """A half with springs half as stiff: 16 joints were each said to be unlike its neighbours."""
    path = Chain(stiffer=dict.fromkeys(range(11, 21), 0.5)).write(tmp_path)
    (fault,) = [
        one for one in Inspection(inspect_model(path)).faults if one.subject == "uniformity"
    ]
    assert re.search(r"1\d of 20 joints are off a smooth course of EI", str(fault))
    assert "more, which --write sets" in str(fault)
