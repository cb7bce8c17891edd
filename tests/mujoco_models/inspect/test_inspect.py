"""What is measured of models as people write them, and what is planted in them."""

import re

import mujoco
import numpy as np
import pytest

from analytic import InputError
from mujoco_models import available_beams, inspect_model, shipped_models
from mujoco_models.quiet import unlogged
from tests.mujoco_models.inspect.chains import Chain, OnRail

BENDS = '<joint axis="0 0 1" stiffness="20.0"'
END = "</mujoco>"


def measured(tmp_path, chain=None, *changes, **names):
    return inspect_model((chain or Chain()).write(tmp_path, *changes), **names)


def test_a_sound_chain_is_the_beam_that_it_stands_for(tmp_path):
    found = measured(tmp_path)
    assert found.length == pytest.approx(1.0)
    assert [j.flexural_rigidity for j in found.joints] == pytest.approx([1.0] * 20, rel=1e-6)
    # The midpoint rule of the integral of (1 - s)^2: 1/(4 N^2) of it is missing.
    assert found.tip_rigidity == pytest.approx(1 / (1 - 1 / 1600), rel=1e-6)
    assert found.mass == pytest.approx(0.313 * (1 - 1 / 40), rel=1e-6)
    # A uniform cantilever of 0.313 EI T^2/L^4 a length has the first period 1: Rao, chapter 8.
    assert found.period == pytest.approx(1.0, rel=5e-3)
    # Dampers of 0.016 times the stiffness: zeta = 0.016 omega/2.
    assert found.damping_ratio == pytest.approx(0.008 * 2 * np.pi / found.period, rel=1e-6)
    assert found.natural_curvature == pytest.approx(0, abs=1e-12)
    assert found.drive == "mocap body 'whisker-foot'"
    for sensor in (found.force, found.torque):
        np.testing.assert_allclose(sensor.axes, np.eye(3), atol=1e-6)
        np.testing.assert_allclose(sensor.lever, 0, atol=1e-3)


def test_a_cone_of_balls_twists_as_easily_as_it_bends(tmp_path):
    """Ten to one, whose tip shows an EI a hundredth of the clamp's."""
    cone = Chain(stiffer={i: (1 - 0.9 * i / 20) ** 4 for i in range(1, 21)})
    balls = ('<joint axis="0 0 1"', '<joint type="ball"'), ('springref="0.0"', "")
    assert measured(tmp_path, cone, *balls).torsion == pytest.approx(1, rel=1e-6)


def test_a_sensor_on_a_link_turns_with_it(tmp_path):
    site, link = '<site name="clamp" />', '<body name="whisker3" pos="0 0.05 0">'
    found = measured(tmp_path, Chain(), (site, ""), (link, link + site))
    assert found.force.bends and found.torque.bends
    assert not measured(tmp_path).force.bends


@pytest.mark.parametrize("first", ["centre", "start", "end"])
def test_where_it_first_bends_shows_in_its_first_cell(tmp_path, first):
    found = measured(tmp_path, Chain(first=first))
    ratio = {"centre": 1.0, "start": 0.5, "end": 1.5}[first]
    assert found.joints[0].flexural_rigidity == pytest.approx(ratio, rel=1e-6)
    assert found.length == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("torsion", "tilt", "at_rest"),
    [(0.1, 0.0, 0.0), (0.8, 0.0, 0.0), (0.1, 0.7, 0.0), (0.8, 0.7, 0.01)],
)
def test_a_hinge_along_it_twists_it(tmp_path, torsion, tilt, at_rest):
    """By a load: not by what it is twisted at rest, where its hinges are in no plane."""
    twists = f'<joint axis="0 1 0" stiffness="{20 * torsion}" damping="0.1" '
    twists += f'springref="{at_rest}"/>'
    turned = f'name="whisker-foot" euler="{tilt} 0.3 0"'
    changes = (BENDS, twists + BENDS), ('name="whisker-foot"', turned)
    found = measured(tmp_path, Chain(), *changes)
    assert found.torsion == pytest.approx(torsion, rel=0.02 if at_rest else 1e-6)
    assert measured(tmp_path).torsion == np.inf


def test_a_twist_slower_than_the_bending_sets_no_period(tmp_path):
    twists = '<joint axis="0 1 0" stiffness="0.2" armature="0.01"/>'
    found, bare = measured(tmp_path, Chain(), (BENDS, twists + BENDS)), measured(tmp_path)
    assert found.period == pytest.approx(bare.period, rel=1e-5)
    assert found.period_without_armature == pytest.approx(found.period, rel=1e-9)
    assert found.damping_ratio == pytest.approx(bare.damping_ratio, rel=1e-5)


def test_it_is_measured_in_its_own_units_and_curved_by_its_springs(tmp_path):
    found = measured(tmp_path, Chain(length=100.0, radius=0.5, rigidity=640.0, curvature=0.004))
    assert found.length == pytest.approx(100.0)
    assert found.joints[3].flexural_rigidity == pytest.approx(640.0, rel=1e-6)
    assert found.natural_curvature == pytest.approx(0.004, rel=1e-6)


def test_a_sensor_is_read_in_whatever_frame_it_has(tmp_path):
    found = measured(tmp_path, Chain(site='euler="0 0 0.3" pos="0 -0.1 0"'))
    c, s = np.cos(0.3), np.sin(0.3)
    np.testing.assert_allclose(found.force.axes, [[c, s, 0], [-s, c, 0], [0, 0, 1]], atol=1e-6)
    np.testing.assert_allclose(found.torque.lever, [0, -0.1, 0], atol=1e-3)


def test_a_foot_on_a_slide_is_held_all_the_same(tmp_path):
    slide = Chain(foot="", inside_foot='<joint name="rail" type="slide" axis="1 0 0"/>')
    found = measured(tmp_path, slide)
    assert found.drive == "slide 'rail' without an actuator"
    assert found.tip_rigidity == pytest.approx(1.0006, abs=1e-4)
    np.testing.assert_allclose(found.force.axes, np.eye(3), atol=1e-6)


@pytest.mark.parametrize(
    "foot",
    [
        Chain(foot=""),
        Chain(foot="", inside_foot="<freejoint/>"),
        Chain(foot="", inside_foot='<joint type="slide" axis="0 0 1"/>'),  # along its hinges
        Chain(foot="", inside_foot='<joint type="slide" axis="0 1 0"/>'),  # along itself
    ],
)
def test_what_cannot_move_the_foot_across_is_no_drive(tmp_path, foot):
    assert measured(tmp_path, foot).drive is None


def test_a_free_foot_on_a_hand_is_driven_by_the_hand(tmp_path):
    held = Chain(foot="", inside_foot="<freejoint/>", beside='<body name="hand" mocap="true"/>')
    weld = f'<equality><weld body1="hand" body2="whisker-foot"/></equality>{END}'
    found = measured(tmp_path, held, (END, weld))
    assert found.drive == "free joint 'joint 0' on mocap body 'hand', by a weld"


def test_a_last_link_may_be_thicker_than_it_is_long(tmp_path):
    """A box of 0.0125 L, 0.04 L thick: its longest side is across the vibrissa."""
    # The first geom touches the second, which is no matter here.
    found = measured(tmp_path, Chain(links=40, radius=0.02, tip='type="box"'))
    assert found.length == pytest.approx(1.0)
    assert found.natural_curvature == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    "joint", ['type="ball"', 'axis="1 0 0" name="first{}"/><joint axis="0 0 1"']
)
def test_where_hinges_leave_the_plane_open_it_is_the_slides_or_the_sensors(tmp_path, joint):
    """An oblique vibrissa whose links turn both ways: no sensor of it is turned."""
    path = Chain(foot='mocap="true" euler="0.3 0.5 0.7"', links=8).write(tmp_path)
    text, count = path.read_text(), 0
    while '<joint axis="0 0 1"' in text:
        text = text.replace('<joint axis="0 0 1"', f"<joint  {joint.format(count)}", 1)
        count += 1
        text = text.replace('/><joint axis="0 0 1"', '  stiffness="8"/><joint  axis="0 0 1"')
    path.write_text(text)
    found = inspect_model(path)
    for sensor in (found.force, found.torque):
        assert np.sort(np.abs(sensor.axes), axis=None)[-3:] == pytest.approx([1, 1, 1], abs=1e-5)
    site, rail = '<site name="clamp"', '<joint name="rail" type="slide" axis="0.6 0 0.8"/>'
    path.write_text(text.replace('mocap="true"', "").replace(site, rail + site))
    assert inspect_model(path).drive == "slide 'rail' without an actuator"


def test_includes_are_found(tmp_path):
    path = Chain().write(tmp_path)
    (tmp_path / "world.xml").write_text('<mujoco><include file="whisker.xml"/></mujoco>')
    assert inspect_model(tmp_path / "world.xml").length == inspect_model(path).length


@pytest.mark.parametrize("name", shipped_models())
def test_shipped_models_are_measured(name):
    lacks = {"cable": "only MuJoCo 3 has composite cables", "rod": "needs MuJoCo 4"}
    for beam, said in lacks.items():
        if beam in name and beam not in available_beams():
            with pytest.raises(InputError, match=said):
                inspect_model(shipped_models()[name])
            return
    found = inspect_model(shipped_models()[name])
    assert found.length == pytest.approx(0.1)
    first = found.joints[len(found.joints) // 2].flexural_rigidity
    assert first == pytest.approx(6.44e-4, rel=1e-3) or name == "tapered-whisker"


TWO = Chain(foot="", sensors="").text("other")


@pytest.mark.parametrize("touches", ["", 'contype="0" conaffinity="0"'])
def test_what_is_only_seen_is_no_part_of_it(tmp_path, touches):
    """Balls on capsules, whether these touch or nothing does."""
    seen = '<geom type="sphere" size="0.03" pos="0 0.05 0.1" contype="0" conaffinity="0" mass="0"/>'
    geoms = 'condim="1"', f'condim="1" {touches}'
    found = measured(tmp_path, Chain(), geoms, ("<joint axis", f"{seen}<joint axis"))
    assert [geom.radius for geom in found.geoms] == [0.005] * 21
    assert found.length == pytest.approx(1)


def test_what_is_only_seen_on_the_rigid_first_link_is_no_part_of_it(tmp_path):
    """A pair of a visual and a colliding capsule was said to meet no object."""
    first = '<geom name="whisker-geom0" fromto="0 0 0 0 0.025 0"'
    seen = '<geom fromto="0 0 0 0 0.025 0" contype="0" conaffinity="0" mass="0"/>'
    found = measured(tmp_path, Chain(), (first, seen + first))
    assert [geom.name for geom in found.geoms[:2]] == ["whisker-geom0", "whisker-geom1"]
    assert all(geom.meets for geom in found.geoms)


@pytest.mark.parametrize(
    ("shape", "begins"),
    [
        ('type="box" pos="0 0.0125 0" size="0.005 0.0125 0.005"', 0.0),
        ('type="cylinder" pos="0 0.0125 0" size="0.02 0.0125"', 0.025),
    ],
)
def test_it_begins_with_what_goes_on_as_it_does_and_is_as_thick(tmp_path, shape, begins):
    """A box of links does, a housing about its axis does not, without a sensor there."""
    own = '<geom name="whisker-geom0" fromto="0 0 0 0 0.025 0"/>'
    turned = 'quat="1 1 0 0"' if "cylinder" in shape else ""
    found = measured(tmp_path, Chain(sensors=""), (own, f"<geom {turned} {shape}/>"))
    assert found.length == pytest.approx(1 - begins)


@pytest.mark.parametrize("link", [1, 20])
@pytest.mark.parametrize("behind", [False, True])
def test_a_ball_on_a_joint_is_neither_where_it_begins_nor_where_it_ends(tmp_path, link, behind):
    path, ball = Chain().write(tmp_path), '<geom type="sphere" size="0.005"/>'
    text = path.read_text()
    (own,) = re.findall(f'<geom name="whisker-geom{link}" [^>]*>', text)
    path.write_text(text.replace(own, own + ball if behind else ball + own))
    found = inspect_model(path)
    assert found.length == pytest.approx(1.0)
    assert found.joints[0].s == pytest.approx(1 / 40)


@pytest.mark.parametrize(("behind", "begins"), [(0.0, 0.0), (0.01, 0.01), (-0.05, 0.025)])
def test_a_first_piece_without_a_geom_begins_at_the_sensor(tmp_path, behind, begins):
    """Half a cell before the hinge; what is farther behind is a bracket."""
    path = Chain(site=f'pos="0 {behind} 0"').write(tmp_path)
    path.write_text(re.sub('<geom name="whisker-geom0"[^>]*>', "", path.read_text()))
    found = inspect_model(path)
    assert found.length == pytest.approx(1 - begins)
    assert found.joints[0].s == pytest.approx(0.025 - begins, abs=1e-12)


@pytest.mark.parametrize(
    ("option", "least", "most"),
    [
        ("", 0, 1e-3),
        ('solver="PGS" iterations="20"', 0, 5e-3),
        ('solver="Newton" tolerance="1"', 0.01, np.inf),
        ('solver="CG" iterations="1" tolerance="1e-2"', 0.1, np.inf),
    ],
)
@pytest.mark.parametrize("chain", [OnRail(), Chain()])
def test_a_solver_that_stops_early_is_seen_past_an_object(tmp_path, chain, option, least, most):
    path = chain.write(tmp_path, ("<option ", f"<option {option} "))
    assert least <= inspect_model(path).unsolved <= most


@pytest.mark.parametrize("integrator", ["Euler", "Euler, all explicit", "implicitfast", "RK4"])
@pytest.mark.parametrize("name", ["tutorial-chain", "mistakes"])
def test_steps_are_stable_up_to_what_is_stated(name, integrator, tmp_path):
    """The servo of the foot is explicit in Euler's; dampers of one joint slow all vibrations."""
    spec = mujoco.MjSpec.from_file(str(shipped_models()[name]))
    integrator, *explicit = integrator.split(", ")
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EULERDAMP) * len(explicit)
    spec.option.gravity = [0, 0, 0]
    spec.option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    spec.compile()
    (path := tmp_path / "model.xml").write_text(spec.to_xml())
    stated = inspect_model(path).stable_step
    for share in (0.99, 1.01):
        model = mujoco.MjModel.from_xml_path(str(path))
        model.opt.timestep = share * stated
        data, fastest = mujoco.MjData(model), 0.0
        data.qvel[:] = 1e-9 * np.random.default_rng(0).standard_normal(model.nv)
        with unlogged():
            for _ in range(1500):
                mujoco.mj_step(model, data)
                fastest = max(fastest, float(np.abs(data.qvel).max()))
        assert (fastest < 1e-5) == (share < 1)


def test_what_has_no_name_has_a_number(tmp_path):
    foot = Chain(foot="", inside_foot='<joint type="slide" axis="1 0 0"/>')
    found = measured(tmp_path, foot, ('name="F" ', ""), ('name="whisker-foot"', ""))
    assert found.force.name == "sensor 0"
    assert found.foot == "body 1"
    assert found.drive == "slide 'joint 0' without an actuator"


def test_what_is_kept_from_the_world_meets_no_object(tmp_path):
    """It was sound, and let an object through where its tip is."""
    pair = '<contact><exclude body1="whisker20" body2="world"/></contact>'
    *others, last = measured(tmp_path, Chain(), (END, pair + END)).geoms
    assert last.kept_apart and not last.meets
    assert all(geom.meets and not geom.kept_apart for geom in others)


def test_places_are_arc_lengths_of_a_curved_one_too(tmp_path):
    """On a straight line from the clamp its tip would be at 0.96 L."""
    found = measured(tmp_path, Chain(curvature=0.5))
    assert found.geoms[-1].end == pytest.approx(found.length)
    assert [g.start for g in found.geoms[1:]] == pytest.approx([j.s for j in found.joints])
    assert max(geom.aside for geom in found.geoms) < 1e-9


def test_the_name_of_the_foot_chooses_between_two(tmp_path):
    both = Chain(beside=TWO.replace('name="clamp"', 'name="c2"'))
    found = measured(tmp_path, both, foot="whisker-foot")
    assert found.foot == "whisker-foot"
    assert measured(tmp_path, both, geoms="other-*").foot == "other-foot"


def _softest(tmp_path, solref, solimp):
    stands = 'solref="0.02 1" solimp="0.98 0.98 0.001"'
    changed = stands, f'solref="{solref}" solimp="{solimp}"'
    return min(geom.stiffness for geom in measured(tmp_path, Chain(), changed).geoms)


def test_an_impedance_that_grows_with_the_depth_softens_the_contact(tmp_path):
    """MuJoCo divides by the square of the largest, at any depth."""
    even = _softest(tmp_path, "0.02 1", "0.9 0.9 0.001")
    grows = _softest(tmp_path, "0.02 1", "0.9 0.95 1e6")  # no depth of this width
    assert grows / even == pytest.approx((0.9 / 0.95) ** 2)


@pytest.mark.parametrize("solref", ["0.02 1e300", "0.02 0", "1e300 1", "-1e300 -1", "0 0"])
@pytest.mark.parametrize("solimp", ["0.9 0.95 0.001", "0 0 0", "1 1 1e-3 0.5 1e300"])
def test_contacts_as_nobody_would_set_them_have_a_stiffness(tmp_path, solref, solimp):
    assert _softest(tmp_path, solref, solimp) > 0
