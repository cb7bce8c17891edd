"""What inspections find wrong, and which beams MuJoCo has, for tests of them."""

import pytest

from analytic import Beam
from compare.simulate.inspection import Inspection
from mujoco_models import available_beams

WIRE = Beam(0.1, 6.44e-4, 2.5e-4)  # what the shipped models are of
rods = pytest.mark.skipif("rod" not in available_beams(), reason="a rod bends since MuJoCo 4")
cables = pytest.mark.skipif("cable" not in available_beams(), reason="MuJoCo 4 has no cables")


def faults_in(inspection: Inspection) -> set[str]:
    return {fault.subject for fault in inspection.faults}
