"""One call for every simulation, and one for every budget."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import InputError, Sweep, circle, named_case
from analytic.space import FootPath, SpatialCase, SpatialReadings, sphere
from compare import measure_budget
from compare.simulate import budgets
from compare.simulate.dispatch import at_rest, simulate
from mujoco_models import Motion, OwnModel, Settings, SpatialSettings, simulate_sweep

CASE = replace(named_case("catenary"), sweep=Sweep(8))
COARSE = Settings(segments=6, contour_points=60)
SPACE = SpatialCase(
    body=sphere(1.0, (0.0, 1.4, 0.0)), path=FootPath([[1.1, 0.3], [0.8, 0.3]], stations=6)
)


def test_what_is_swept_is_what_was_asked_for():
    begun = []
    found = simulate(CASE, COARSE, advance=lambda: begun.append(1))
    assert len(begun) == 8
    np.testing.assert_array_equal(
        found.values("force_y"), simulate_sweep(CASE, COARSE).values("force_y")
    )
    assert "motion" in simulate(CASE, COARSE, Motion(speed=0.5, timestep=0.02)).provenance
    spatial = simulate(SPACE, SpatialSettings(segments=6))
    assert isinstance(spatial, SpatialReadings)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((SPACE, SpatialSettings(), None, None, "drake"), "mujoco in space"),
        ((CASE, COARSE, Motion(), None, "drake"), "mujoco in motion"),
        ((CASE, COARSE, None, None, "none"), "one of mujoco"),
        ((SPACE, COARSE), "a Settings: must be a SpatialSettings"),
        ((CASE, SpatialSettings()), "a SpatialSettings: must be a Settings"),
    ],
)
def test_what_no_engine_can_sweep_is_refused(arguments, said):
    with pytest.raises(InputError, match=said):
        simulate(*arguments)


def test_the_contacts_at_rest_are_as_stiff_as_in_motion():
    motion = Motion(contact_stiffness=3e4)
    assert at_rest(COARSE, motion).contact_stiffness == 3e4
    for same in (None, Motion(solref=(0.1, 1.0))):
        assert at_rest(COARSE, same) == COARSE


def test_each_kind_of_case_has_its_budget(monkeypatch):
    asked = []
    monkeypatch.setattr(budgets, "budget_at_rest", lambda *given: asked.append(given))
    monkeypatch.setattr(budgets, "budget_in_motion", lambda *given: asked.append(given))
    motion, model = Motion(contact_stiffness=3e4), OwnModel("whisker.xml")
    measure_budget(CASE)
    measure_budget(CASE, COARSE, motion=motion)
    measure_budget(CASE, COARSE, motion=motion, model=model)
    assert asked[0][:2] == (CASE, Settings())
    assert asked[1][:4] == (CASE, motion, COARSE, None)
    assert asked[2][:4] == (CASE, motion, COARSE, model)
    # What some of its sweeps would refuse is refused before the first: it took four minutes.
    for refused, name in (
        (replace(CASE, friction=0.2), "friction"),
        (replace(CASE, others=(circle(0.1, (-1.0, 0.3)),)), "number of objects"),
    ):
        with pytest.raises(InputError, match=rf"^{name} = .* a budget"):
            measure_budget(refused, COARSE, motion=motion)
    assert len(asked) == 3
