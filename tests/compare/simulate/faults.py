"""What inspections find wrong, and which beams MuJoCo has, for tests of them."""

import pytest

from analytic import Beam
from compare.simulate.inspection import Inspection
from mujoco_models import available_beams, inspect_model

STATED = Beam()
WIRE = Beam(0.1, 6.44e-4, 2.5e-4)  # what the shipped models are of
rods = pytest.mark.skipif("rod" not in available_beams(), reason="a rod bends since MuJoCo 4")
cables = pytest.mark.skipif("cable" not in available_beams(), reason="MuJoCo 4 has no cables")


def faults_in(inspection: Inspection) -> set[str]:
    return {fault.subject for fault in inspection.faults}


def changed(tmp_path, chain, *changes):
    path = chain.write(tmp_path)
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return Inspection(inspect_model(path), STATED)
