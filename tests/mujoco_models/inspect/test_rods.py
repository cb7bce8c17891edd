"""What is measured of MuJoCo 4's rods, and what is planted in them."""

from itertools import pairwise

import mujoco
import numpy as np
import pytest

from analytic import InputError
from mujoco_models import available_beams, inspect_model
from mujoco_models.quiet import unlogged
from tests.mujoco_models.inspect.rods import Rod

pytestmark = pytest.mark.skipif("rod" not in available_beams(), reason="a rod bends since MuJoCo 4")


def measured(tmp_path, rod=None, **names):
    return inspect_model((rod or Rod()).write(tmp_path), **names)


def test_a_sound_rod_is_the_beam_that_it_stands_for(tmp_path):
    found = measured(tmp_path)
    assert found.length == pytest.approx(0.1, rel=1e-6)
    own = [j.flexural_rigidity for j in found.joints]
    # The last one stands for the whole of the last edge.
    assert own == pytest.approx([6.44e-4] * 18 + [1.5 * 6.44e-4], rel=1e-4)
    # The midpoint rule of the integral of (1 - s)^2: 1/(4 N^2) of it is missing.
    assert found.tip_rigidity == pytest.approx(6.44e-4 / (1 - 1 / (4 * 19.5**2)), rel=1e-3)
    # Rao, chapter 8, with the mass of an edge at each vertex: half of the tip's is too much, beside
    # 33/140 of the beam's.
    mass = 1.54e-4 / 21 / (0.1 / 19.5)
    heavier = np.sqrt(1 + 0.5 / 19.5 / (33 / 140))
    expected = 1.787 * 0.1**2 * np.sqrt(mass / 6.44e-4) * heavier
    assert found.period == pytest.approx(expected, rel=0.005)
    # Rayleigh's damping: zeta = beta omega/2.
    assert found.damping_ratio == pytest.approx(4.4e-4 * np.pi / found.period, rel=1e-6)
    assert found.stretch * 3 * 6.44e-4 / 0.1**2 < 5e-3
    assert found.planar
    assert found.drive == "slide 'rail' with actuator 'actuator 0'"
    for sensor in (found.force, found.torque):
        assert sensor.feels_contacts
        np.testing.assert_allclose(sensor.axes, np.eye(3), atol=1e-4)


@pytest.mark.slow
def test_its_dampers_slow_it_as_measured(tmp_path):
    """A free vibration falls by exp(-zeta omega t), with MuJoCo's own steps."""
    rod = Rod(elasticity='damping="4.4e-4"', hand="")
    found = measured(tmp_path, rod)
    model = mujoco.MjModel.from_xml_string(rod.text)
    data = mujoco.MjData(model)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    tip = model.body("hair_20").id
    across = model.jnt_qposadr[model.body_jntadr[tip]]
    data.xfrc_applied[tip, 0] = 1e-2 * 6.44e-4 / 0.1**2
    for _ in range(600):
        mujoco.mj_step(model, data)
    data.xfrc_applied[:] = 0
    model.opt.timestep = 2e-5  # `discrete` damps, too: zeta = omega dt/2
    way = []
    for _ in range(round(2.2 * found.period / 2e-5)):
        mujoco.mj_step(model, data)
        way.append(data.qpos[across])
    way = np.array(way)
    crossings = np.flatnonzero(np.diff(np.sign(way)) != 0)
    half = np.diff(crossings).mean()
    assert 2 * half * 2e-5 == pytest.approx(found.period, rel=0.02)
    swings = [np.abs(way[i:j]).max() for i, j in pairwise(crossings)]
    falls = np.log(swings[0] / swings[-1]) / (len(swings) - 1) / np.pi
    numerical = np.pi / found.period * 2e-5
    assert falls - numerical == pytest.approx(found.damping_ratio, rel=0.05)


@pytest.mark.slow
def test_sensors_of_its_own_tree_read_nothing_of_contacts(tmp_path):
    """MuJoCo's cfrc_ext leaves out what touches a flex; a weld carries it to the hand."""
    read = {}
    for own_tree in (True, False):
        rod = Rod(own_tree=own_tree, hand="")
        text = rod.text.replace(
            "<worldbody>", '<worldbody><geom type="sphere" size="0.01" pos="0.0095 0.07 0"/>'
        )
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        for _ in range(2000):
            mujoco.mj_step(model, data)
        push, wrench = 0.0, np.zeros(6)
        for i in range(data.ncon):
            mujoco.mj_contactForce(model, data, i, wrench)
            push += wrench[0] * abs(data.contact.frame[i, 0])
        assert push > 1e-4
        read[own_tree] = abs(data.sensordata[0]) / push
        assert measured(tmp_path, rod).force.feels_contacts is not own_tree
    assert read[True] < 1e-3
    assert read[False] == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize(
    ("rod", "said"),
    [
        (Rod(pin="0"), "flex 'hair' = held by fewer than two vertices.*<pin id=\"0 1\"/>"),
        (Rod(edge='<edge equality="false"/>'), "flex 'hair' = with edges that nothing keeps"),
        (Rod(hand="", own_tree=True, rigidity=0.0), "flex 'hair' = without a stiffness"),
        (Rod(edge='<edge equality="true" damping="1"/>'), "flex 'hair' = with springs or dampers"),
    ],
)
def test_what_is_no_vibrissa_is_one_line(tmp_path, rod, said):
    path = rod.write(tmp_path)
    path.write_text(rod.text.replace('"discrete"', '"Euler"'))
    with pytest.raises(InputError, match=said) as caught:
        inspect_model(path)
    assert "\n" not in str(caught.value)


def test_eulers_steps_are_stable_up_to_what_is_stated(tmp_path):
    """They broke its inspection."""
    path = tmp_path / "rod.xml"
    rod = Rod(elasticity="", own_tree=True, hand="", edge='<edge equality="true"/>')
    path.write_text(rod.text.replace('"discrete"', '"Euler"'))
    stated, speeds = inspect_model(path).stable_step, []
    for share in (0.98, 1.02):
        model = mujoco.MjModel.from_xml_path(str(path))
        model.opt.timestep = share * stated
        data = mujoco.MjData(model)
        data.qvel[:] = 1e-9 * np.random.default_rng(0).standard_normal(model.nv)
        with unlogged():
            mujoco.mj_step(model, data, 1500)
        speeds.append(np.abs(data.qvel).max())
    assert speeds[0] < 1e-6 < speeds[1]


def test_steps_too_short_to_be_measured_by_are_refused_at_once(tmp_path):
    """It would take 10^10 of them to rest."""
    path = tmp_path / "rod.xml"
    path.write_text(Rod().text.replace('timestep="0.0005"', 'timestep="5e-10"'))
    with pytest.raises(InputError, match=r"timestep = 5e-10: must be at least 1.*e-06, "):
        inspect_model(path)


@pytest.mark.slow
def test_nothing_is_written_beside_it(tmp_path, monkeypatch):
    """MuJoCo's warnings go to no file: its solver does not get to a tolerance of 0, and warns."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("mujoco_models.inspect.held_rod._TOLERANCE", 0.0)
    path = Rod(edges=4, edge='<edge equality="true"/>', weld="").write(tmp_path)
    inspect_model(path)
    assert [*tmp_path.iterdir()] == [path]
