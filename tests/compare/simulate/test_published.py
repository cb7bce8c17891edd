"""Published whiskers, rebuilt from their numbers: straight, on a slide, sensors at the clamp."""

import pytest

from compare.simulate.fixing import fix
from compare.simulate.inspection import Inspection
from mujoco_models import available_beams, inspect_model

# github.com/SVDouble/RatteChan, ratte/models/platform.xml; github.com/hao-l1/WhiskerFBG,
# mujoco_xml/calibration.xml: length, radius, E, G, dampers, armature, time step and contacts.
WHISKERS = {
    "RatteChan": (0.1, 1.25e-4, 100e9, 40e9, 1e-4, 1e-5, 'timestep="0.002"', 'condim="1"'),
    "WhiskerFBG": (
        0.05356, 1.524e-4, 7.5e10, 2.8e10, 0.005, 3e-5, 'timestep="0.001"',
        'condim="6" friction="0.2 1e-4 1e-4" solref="0.002 1" solimp="0.15 0.4 0.004 0.9 6"',
    ),
}  # fmt: skip
CABLE = """\
<mujoco><option gravity="0 0 0" integrator="implicitfast" {step}/>
<extension><plugin plugin="mujoco.elasticity.cable"/></extension>
<worldbody><body name="base"><joint name="rail" type="slide" axis="0 1 0" armature="10"/>
<inertial pos="0 0 0" mass="0.01" diaginertia="1e-5 1e-5 1e-5"/><site name="clamp"/>
<composite prefix="w" type="cable" curve="s 0 0" count="40 1 1" size="{length} 0 0" initial="none">
<plugin plugin="mujoco.elasticity.cable"><config key="twist" value="{twist}"/>
<config key="bend" value="{bend}"/></plugin>
<joint kind="main" damping="{damping}" armature="{armature}"/>
<geom type="capsule" size="{radius}" density="6450" {contact}/></composite></body></worldbody>
<actuator><velocity joint="rail" kv="1e4"/></actuator>
<sensor><force site="clamp"/><torque site="clamp"/></sensor></mujoco>
"""


@pytest.mark.skipif("cable" not in available_beams(), reason="MuJoCo 4 has no cables")
@pytest.mark.parametrize(
    ("name", "subjects"),
    [("RatteChan", {"clamp", "contact"}), ("WhiskerFBG", {"clamp", "contact", "damping"})],
)
def test_published_cables_have_their_faults_and_no_others(name, subjects, tmp_path):
    """Swept, the rigid first cell that is left makes all readings 4 % too large, as it says."""
    length, radius, bend, twist, damping, armature, step, contact = WHISKERS[name]
    path = tmp_path / "cable.xml"
    path.write_text(CABLE.format(**locals()))
    before = Inspection(inspect_model(path))
    assert {r.subject for r in before.remarks if r.kind == "fault"} == subjects
    after = fix(path, {}, before, tmp_path / "fixed.xml").inspection
    left = [r for r in after.remarks if r.kind == "fault"]
    assert [r.subject for r in left] == ["clamp"]
    assert "EI 4.0% higher" in left[0].text
