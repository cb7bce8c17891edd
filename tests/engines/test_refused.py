"""What an engine has not is one line, before anything is swept."""

from dataclasses import replace

import pytest

from analytic import Beam, Case, InputError, circle, named_case, polygon
from engines import find_engine
from engines.precision.gate import gate
from mujoco_models import Settings
from tests.engines.needs import needs

ENGINES = {"drake": "drake", "pinocchio": "pin", "dart": "dartpy", "pyelastica": "pyelastica",
           "exudyn": "exudyn"}  # fmt: skip
TWINS = ("drake", "pinocchio")
CATENARY, CIRCLE = named_case("catenary"), circle(1.0, (0.0, 0.4))
CORNERS = Case(profile=polygon([(-0.5, 0.8), (0.0, 0.5), (0.5, 0.8)]))
THIN = Case(Beam(radius=0.0), CIRCLE)
RUBBING = replace(CATENARY, friction=0.2)
REFUSED = [
    *((name, RUBBING, Settings(), "friction") for name in ENGINES),
    *((name, THIN, Settings(), "cannot collide a line") for name in ENGINES if name != "exudyn"),
    *((name, CATENARY, Settings(beam="rod"), "beam for") for name in TWINS),
    *((name, CATENARY, Settings(planar=False), "out of the plane") for name in TWINS),
    *((name, CORNERS, Settings(), "with sharp corners") for name in TWINS),
    *((name, Case(profile=circle(0.003, (0.0, 0.5))), Settings(), "smallest radius of curvature")
      for name in TWINS),
    *((name, named_case("pre-curved"), Settings(), "natural_curvature")
      for name in ("dart", "pyelastica")),
    ("exudyn", Case(Beam(tip_radius=0.001), CIRCLE), Settings(), "tip_radius.*exudyn cannot"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "case", "settings", "says"), REFUSED)
def test_what_an_engine_has_not_is_a_line(name, case, settings, says):
    needs(ENGINES[name])
    with pytest.raises(InputError, match=says):
        find_engine(name).sweep(case, settings)


@pytest.mark.parametrize(
    ("case", "settings", "says"),
    [
        (CATENARY, Settings(beam="rod"), "beam for --float32"),
        (CORNERS, Settings(), "primitive"),
        (RUBBING, Settings(), "friction"),
    ],
)
def test_what_cannot_be_looked_at_in_single_precision_is_a_line(case, settings, says):
    with pytest.raises(InputError, match=says):
        gate(case, settings, {}, (1e4,))
