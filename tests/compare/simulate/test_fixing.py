"""What `inspect --write` makes of models that are written badly."""

import re
from dataclasses import replace

import mujoco
import pytest

from analytic import Beam, find_events, solve_sweep
from compare import compare
from compare.read.case import load_case
from compare.simulate.expected import SPEED, expected, hurry
from compare.simulate.fixing import case_of, fix
from compare.simulate.inspection import Inspection
from compare.simulate.profile import profile
from compare.simulate.rigidity import at_its_tip, by_its_clamp, hand_softens
from compare.simulate.treatment import timestep
from mujoco_models import inspect_model, shipped_models, simulate_model
from mujoco_models.fix.edit import Edit
from tests.compare.simulate.faults import faults_in
from tests.mujoco_models.inspect.chains import Chain, OnRail

WELDED = (
    '<body name="hand" mocap="true"/>',
    '<equality><weld body1="hand" body2="whisker-foot"/></equality></mujoco>',
)
RAIL = '<joint name="rail" type="slide" axis="1 0 0" armature="1e5"/>'
WEIGHT = '<inertial pos="0 0 0" mass="1e-3" diaginertia="1e-3 1e-3 1e-3"/>'
# Swept so, moments were 7 % off.
LATE = '<force name="F" site="clamp"/><torque name="T" site="clamp" delay="1" nsample="200"/>'
ANOTHER = '<body name="other"><site name="clamp-force"/></body>'
NAMED = '<framepos name="clamp-torque" objtype="site" objname="clamp-force"/>'
delays = pytest.mark.skipif(not hasattr(mujoco.MjModel, "sensor_delay"), reason="MuJoCo is older")
WRIST = '<actuator><motor joint="wrist"/></actuator></mujoco>'
MOTOR = '<actuator><velocity joint="rail" kv="1e7"/></actuator></mujoco>'


def fixed(path):
    before = Inspection(inspect_model(path))
    return before, fix(path, {}, before, path.with_name("fixed.xml"))


def on_rail(tmp_path, *changes, **chain):
    path = Chain(foot="", inside_foot=RAIL + WEIGHT, **chain).write(tmp_path)
    text = path.read_text().replace("</mujoco>", MOTOR)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


def welded(tmp_path, inside="", **chain):
    path = Chain(foot="", inside_foot="<freejoint/>" + inside, **chain).write(tmp_path)
    text = path.read_text().replace("<worldbody>", "<worldbody>" + WELDED[0])
    path.write_text(text.replace("</mujoco>", WELDED[1]))
    return path


def test_steps_are_those_of_the_stiffness_that_was_meant(tmp_path):
    """Of one in N mm, taken for N m, they were kept: 1/32 of what is needed."""
    meant = Beam(length=1.0, radius=0.005)
    steps = []
    for rigidity in (1.0, 1e3):
        path = on_rail(tmp_path, ('integrator="discrete"', 'integrator="Euler"'), rigidity=rigidity)
        before = Inspection(inspect_model(path), meant)
        after = fix(path, {}, before, tmp_path / "fixed.xml")
        steps.append(after.inspection.found.timestep)
    assert any("1e+03 times what is stated: in another unit?" in f.text for f in before.faults)
    assert steps[1] == pytest.approx(steps[0], rel=0.02)


@pytest.mark.parametrize("flag", [None, "equality"])
def test_a_soft_weld_is_no_clamp_and_its_free_body_feels_nothing(tmp_path, flag):
    path = welded(tmp_path)
    if flag:
        option = f'<option><flag {flag}="disable"/></option></mujoco>'
        path.write_text(path.read_text().replace("</mujoco>", option))
    before, after = fixed(path)
    assert faults_in(before) >= {"clamp", "force sensor", "torque sensor"}
    assert ("flags" in faults_in(before)) is bool(flag)
    (said,) = (fault for fault in before.faults if fault.subject == "force sensor")
    assert "leaves the weld" in said.text
    assert "a body of its own" in said.remedy
    assert faults_in(after.inspection) == {"force sensor", "torque sensor"}
    assert any("2 faults are left, to fix by hand" in line for line in after.lines())
    assert sum("let a body of its own, in the free one" in line for line in after.lines()) == 2
    weld = after.inspection.found.hand
    assert weld.rotation < 1e-3
    assert weld.displacement < 1e-3


def test_a_welded_foot_has_a_speed_and_feels_by_a_body_of_its_own(tmp_path):
    """Not by one on the first link, which turns with it: its force_x is 6 % off."""
    path = welded(tmp_path, WEIGHT, gravity="100 0 0")
    text = path.read_text()
    (said,) = (r.text for r in Inspection(inspect_model(path)).faults if r.subject == "gravity")
    assert "force sensor" not in said  # which reads nothing
    first = '<body name="whisker1" pos="0 0.025 0">'
    site = '<site name="clamp" />'
    path.write_text(text.replace(site, "").replace(first, f"{first}{site}"))
    assert "on a link" in next(r.text for r in fixed(path)[0].faults if "sensor" in r.subject)
    head, _, inside = text.partition(site)
    inside, _, tail = inside.rpartition("</body></worldbody>")
    path.write_text(f'{head}<body name="mount">{site}{inside}</body></body></worldbody>{tail}')
    before, after = fixed(path)
    assert "foot" not in {remark.subject for remark in before.remarks}
    assert after.inspection.sound


AT_ITS_END = '0" range="-1 0" solreflimit="-1e9 -1e5'


@pytest.mark.parametrize(("stiffness", "sound"), [("0", False), (AT_ITS_END, False), ("2e3", True)])
def test_a_driven_hinge_between_drive_and_vibrissa_has_to_be_stiff(tmp_path, stiffness, sound):
    """One that rests at its end, which is to one side, was as stiff as half of that."""
    wrist = f'<joint name="wrist" axis="0 0 1" stiffness="{stiffness}"/>'
    motors = '<actuator><motor joint="wrist"/>'
    path = on_rail(tmp_path, (RAIL, RAIL + wrist), ("<actuator>", motors))
    before, after = fixed(path)
    assert before.sound is sound
    assert after.inspection.sound
    if not sound:
        assert before.found.hand.joints == ("wrist",)
        assert "gives way between drive and vibrissa, at 'wrist'" in str(before.remarks[0])


@pytest.mark.parametrize(
    ("changes", "chain", "subjects"),
    [
        ([('timestep="0.01"', 'timestep="0"')], {}, {"time step"}),
        ([('timestep="0.01"', 'timestep="18"')], {}, {"time step", "contact"}),
        ([('solref="0.02 1" solimp="0.98 0.98 0.001"', 'solref="0.1 1"')], {}, {"contact"}),
        ([('solref="0.02 1"', 'solref="-1e8 -2e4"')], {}, {"contact"}),
        ([('condim="1"', 'margin="0.02"')], {}, {"contact"}),
        ([], {"first": "start"}, {"clamp"}),
        ([], {"first": "end", "links": 30}, {"clamp"}),
        ([], {"stiffer": {5: 1.3}}, {"uniformity"}),
        ([], {"gravity": "0 -2 0"}, {"gravity"}),
        ([], {"sensors": ""}, {"force sensor", "torque sensor"}),
        ([], {"sensors": NAMED, "beside": ANOTHER}, {"force sensor", "torque sensor"}),
        ([], {"site": 'euler="0 0 0.2"'}, {"force sensor", "torque sensor"}),
        ([], {"site": 'pos="0 -0.1 0"'}, {"torque sensor"}),
        ([('damping="0.3', 'damping="9.3')], {}, {"damping"}),
        ([('<option ', '<option solver="CG" tolerance="1e-6" ')], {}, {"solver"}),
        ([('<option ', '<option solver="CG" iterations="1" tolerance="1" ')], {}, {"solver"}),
        # Swept, 42 of 60 stations of such contacts chattered.
        ([('timestep="0.01"', 'timestep="5e-4"')], {"solref": "0.001 1"}, {"contact"}),
        pytest.param([], {"sensors": LATE}, {"torque sensor"}, marks=delays),
    ],
)  # fmt: skip
def test_what_a_number_fixes_is_fixed(tmp_path, changes, chain, subjects):
    before, after = fixed(on_rail(tmp_path, *changes, **chain))
    assert faults_in(before) == subjects
    assert after.inspection.sound, after.inspection.remarks
    assert len(after.files) == 1


def test_a_step_is_a_fiftieth_of_the_first_period_or_less(tmp_path):
    """What touches with little inertia makes it less."""
    found = inspect_model(on_rail(tmp_path, ('timestep="0.01"', 'timestep="18"')))
    assert timestep(replace(found, geoms=())) == pytest.approx(found.period / 50)
    light = [replace(geom, weight=1e5 * geom.weight) for geom in found.geoms]
    assert timestep(replace(found, geoms=light)) < found.period / 60


def test_a_bead_at_the_tip_is_what_changes_and_not_all_else(tmp_path):
    """All else was made as thick as it."""
    before, after = fixed(on_rail(tmp_path, tip='size="0.02"'))
    assert faults_in(before) == {"radius"}
    assert [edit.numbers for edit in after.edits] == [(before.found.geoms[-1].number,)]
    assert {geom.radius for geom in after.inspection.found.geoms} == {0.005}


def test_the_first_joint_gives_way_as_its_piece_does(tmp_path):
    _, after = fixed(on_rail(tmp_path, first="end", length=2.0))
    found = after.inspection.found
    assert by_its_clamp(found) / at_its_tip(found) == pytest.approx(1, abs=1e-4)


def test_a_sensor_goes_to_where_the_vibrissa_begins(tmp_path):
    """Which is at the first hinge, that nothing is ahead of, and not where its body is."""
    path = on_rail(tmp_path, site='pos="0 -0.1 0"')
    path.write_text(re.sub('<geom name="whisker-geom0"[^>]*>', "", path.read_text()))
    before, after = fixed(path)
    assert "torque sensor" in faults_in(before)
    assert after.inspection.sound, after.inspection.faults
    assert after.inspection.found.torque.clamp == pytest.approx([0, 0.025, 0], abs=1e-9)


def test_what_can_leave_its_plane_is_swept_until_it_would(tmp_path):
    """Farther on chains of balls slip off sideways, in most turns of the world: 20 % rms."""
    path = OnRail().write(tmp_path)
    assert "stop" not in case_of(inspect_model(path), path, {})
    path.write_text(path.read_text().replace('axis="0 0 1"', 'type="ball"'))
    before, after = fixed(path)
    assert before.sound
    assert "until it would leave its plane" in "".join(after.lines())
    (tmp_path / "case.toml").write_text(case_of(after.inspection.found, after.files[0], {}))
    case = load_case(tmp_path / "case.toml").case
    way = find_events(case.profile, case.beam)
    # It stops at the last of 200 stations before that.
    assert case.foot_x[-1] == pytest.approx(way.out_of_plane.foot_x, abs=0.02)
    assert way.snap_off.foot_x < way.out_of_plane.foot_x < case.foot_x[-1]


OPTION = '<option timestep="0.01"'
MOTOR_ALONE = '<velocity joint="rail"'


@pytest.mark.parametrize(
    ("old", "new", "subject"),
    [
        (OPTION, f'<option><flag constraint="disable"/></option>{OPTION}', "flags"),
        (OPTION, f'<option><flag actuation="disable"/></option>{OPTION}', "flags"),
        (OPTION, f'<option o_solref="0.5 1"><flag override="enable"/></option>{OPTION}', "flags"),
        ('name="rail"', 'name="rail" range="-0.5 0.5"', "foot"),
        (MOTOR_ALONE, f'{MOTOR_ALONE} ctrlrange="-0.01 0.01"', "foot"),
        (MOTOR_ALONE, f'{MOTOR_ALONE} forcerange="-1 1"', "foot"),
        (OPTION, f'<option><flag spring="disable"/></option>{OPTION}', "flags"),
        (OPTION, f'<option><flag sensor="disable"/></option>{OPTION}', "flags"),
        ('name="rail"', 'name="rail" actuatorfrcrange="-1 1"', "foot"),
        (MOTOR_ALONE, f'{MOTOR_ALONE} forcerange="-50 50"', "foot"),  # of what weighs 1e5
        ('name="rail"', 'name="rail" frictionloss="3e5"', "foot"),
        ('name="rail"', 'name="rail" damping="1e7"', "foot"),
    ],
)
def test_what_stops_contacts_or_the_drive_is_switched_off(tmp_path, old, new, subject):
    """Swept as they are, they are 26 and 52 % off, or their foot stays behind, or they read 0."""
    before, after = fixed(on_rail(tmp_path, (old, new)))
    assert faults_in(before) == {subject}
    assert after.inspection.sound


@pytest.mark.parametrize(
    ("drive", "sound"),
    [
        ("", False),
        ('<position joint="rail" kp="5e3"/>', False),
        ('<position joint="rail" kp="5e4"/>', True),
    ],
)
def test_a_spring_on_a_slide_is_taken_off_where_it_is_felt(tmp_path, drive, sound):
    """A default of all joints: the sensor feels the foot pulled back, or the foot stays behind."""
    driven = f"<actuator>{drive}</actuator></mujoco>"
    path = on_rail(tmp_path, ('name="rail"', 'name="rail" stiffness="500"'), (MOTOR, driven))
    before, after = fixed(path)
    assert faults_in(before) == (set() if sound else {"foot"})
    assert after.inspection.sound


@pytest.mark.parametrize(
    ("mass", "drive", "said"),
    [
        # Swept, force_x of a whisker of 60 mm on a foot of 0.1 kg was 78 % off, and 0.7 % at 1e5.
        ("1", 'position kp="100"', {"foot"}),
        ("1", 'position kp="1e5"', set()),
        # 3 EI/L^2 over the gain: one that stood back by 0.044 L let go 0.04 L late.
        ("1e-3", 'position kp="80"', {"foot"}),
        ("1e-3", 'position kp="160"', set()),
        # A mobile robot that carried the sensor, 0.7 T1 late, read moments that were 95 % off.
        ("50", 'velocity kv="150"', {"foot"}),
        ("50", 'velocity kv="5000"', set()),
        ("1e-3", 'velocity kv="50"', {"foot"}),
        # One that nothing damps swings on, however fast.
        ("50", 'position kp="5e3"', {"foot"}),
        ("50", 'position kp="5e3" kv="1e3"', set()),
    ],
)
def test_a_foot_that_does_not_follow_is_in_the_readings(tmp_path, mass, drive, said):
    heavy = (WEIGHT, WEIGHT.replace('mass="1e-3"', f'mass="{mass}"'))
    driven = f'<actuator><{drive} joint="rail"/></actuator></mujoco>'
    path = on_rail(tmp_path, heavy, (MOTOR, driven), (' armature="1e5"', ""))
    assert faults_in(Inspection(inspect_model(path))) == said


def test_a_slide_without_a_way_is_that_alone(tmp_path):
    """It was also one that does not keep its speed, and got a body between foot and sensors."""
    heavy = (WEIGHT, WEIGHT.replace('mass="1e-3"', 'mass="50"')), (' armature="1e5"', "")
    driven = '<actuator><velocity kv="5000" joint="rail"/></actuator></mujoco>'
    short = ('name="rail"', 'name="rail" limited="true" range="-1e-9 1e-9"')
    (fault,) = Inspection(inspect_model(on_rail(tmp_path, *heavy, (MOTOR, driven), short))).faults
    assert "its slide ends" in fault.text


def test_a_heavy_arm_that_swings_is_kept_from_the_sensors(tmp_path):
    """Springs held it, and it was sound; its inertia made a moment 2.6 times the largest."""
    arm = '<body name="arm"><inertial pos="0 -0.3 0" mass="90" diaginertia="1 1 1"/>'
    hinge = '<joint name="elbow" pos="0 -1 0" axis="0 0 1" stiffness="4e3"/><site name="clamp"'
    motor = '<actuator><motor joint="elbow"/></actuator></mujoco>'
    ends = ("</worldbody>", "</body></worldbody>"), ("</mujoco>", motor)
    path = on_rail(tmp_path, ('<site name="clamp"', f"{arm}{hinge}"), *ends)
    before, after = fixed(path)
    assert faults_in(before) == {"foot"}
    assert after.inspection.sound
    assert str(after.edits[0]).startswith('<body name="clamp-body"><site name=')
    case = path.with_name("case.toml")
    case.write_text(case_of(after.inspection.found, path.with_name("fixed.xml"), {}))
    job = load_case(case)
    moved = simulate_model(job.case, job.model, job.motion, job.settings)
    exact = solve_sweep(job.case).values("moment_z")
    off = moved.values("moment_z") - exact
    assert abs(off[1:50]).max() < 0.02 * abs(exact).max()  # until it lets go


def test_what_a_frame_holds_gets_no_body_around_it(tmp_path):
    """It would be where the frame is, and not the foot; the fault is left, and said."""
    driven = '<actuator><position joint="rail" kp="5e3"/></actuator></mujoco>'
    heavy = (WEIGHT, WEIGHT.replace('mass="1e-3"', 'mass="50"')), (' armature="1e5"', "")
    first, end = '<body name="whisker1"', "</body></worldbody>"
    frame = (first, f'<frame pos="0 0 0">{first}'), (end, f"</frame>{end}")
    before, after = fixed(on_rail(tmp_path, *heavy, (MOTOR, driven), *frame))
    assert faults_in(before) == faults_in(after.inspection) == {"foot"}
    assert len(after.edits) == 2


def test_each_joint_of_an_arm_gives_way_by_its_own_arm(tmp_path):
    """Joints of an arm that gives way little enough were paired with each other's lever."""
    shoulder = f'{RAIL}{WEIGHT}<joint name="far" pos="-2 0 0" axis="0 0 1" stiffness="1e4"/>'
    near = '<joint name="wrist" axis="0 0 1" stiffness="1e3"/>'
    path = Chain(foot="", inside_foot=near).write(tmp_path)
    text = path.read_text().replace("</mujoco>", WRIST)
    text = text.replace("<worldbody>", f'<worldbody><body name="arm">{shoulder}')
    path.write_text(text.replace("</worldbody>", "</body></worldbody>"))
    found = inspect_model(path)
    assert found.hand.displacement == pytest.approx(2**2 / 1e4, rel=0.05)
    assert hand_softens(found) == pytest.approx(3 * (1 / 1e4 + 1 / 1e3), rel=0.02)
    assert expected(found, SPEED).parts["clamp"] == pytest.approx(hand_softens(found), rel=0.1)


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        ("<freejoint/>", "is free, and nothing holds it"),
        ('<joint name="wrist" axis="0 0 1" stiffness="2e4"/>', "nothing can move"),
    ],
)
def test_what_an_arm_or_nothing_carries_gets_no_rail(tmp_path, inside, said):
    """What it pushed back was the arm, and a free body takes no other joint."""
    path = Chain(foot="", inside_foot=inside + WEIGHT).write(tmp_path)
    if "wrist" in inside:
        path.write_text(path.read_text().replace("</mujoco>", WRIST))
    before, after = fixed(path)
    for inspection in (before, after.inspection):
        assert any(said in str(fault) for fault in inspection.faults)
    assert "vibrissa-rail" not in after.files[0].read_text()


def test_a_rail_leaves_keyframes_and_later_edits_where_they_were(tmp_path):
    path = Chain(foot="", links=4).write(tmp_path)
    key = '<keyframe><key qpos="1 2 3 4" qvel="5 6 7 8"/></keyframe></mujoco>'
    path.write_text(path.read_text().replace("</mujoco>", key))
    _, after = fixed(path)
    before, now = (mujoco.MjModel.from_xml_path(str(file)) for file in (path, after.files[0]))
    assert now.key_qpos[0].tolist() == [0, 1, 2, 3, 4]
    assert now.key_qvel[0].tolist() == [0, 5, 6, 7, 8]
    assert Edit("joint", (), (1, 4)).of(before, now).numbers == (0, 3)
    assert Edit("geom", (), (1, 4)).of(before, now).numbers == (1, 4)


def test_a_drive_that_reaches_as_far_as_a_sweep_is_no_fault(tmp_path):
    """Its limits are those on the way to the left alone; swept so, a slide of 2.2 L stopped it."""
    limits = 'forcerange="-2e3 2e3" ctrlrange="-0.06 0.01"'
    path = on_rail(tmp_path, ('name="rail"', 'name="rail" range="-2.3 0.1"'),
                   (MOTOR_ALONE, f"{MOTOR_ALONE} {limits}"))  # fmt: skip
    assert Inspection(inspect_model(path)).sound


def test_what_else_moves_is_no_foot(tmp_path):
    peg = '<body name="peg" pos="0 2 0" mocap="true"><geom size="0.1" type="sphere"/></body>'
    found = Inspection(inspect_model(Chain(foot="", beside=peg).write(tmp_path)))
    (said,) = (remark for remark in found.remarks if remark.subject == "foot")
    assert said.kind == "note" and "'peg'" in said.text


def test_the_written_case_limits_what_a_user_is_to_expect(tmp_path):
    """At 0.05 L/T1 models let go 0.016 to 0.02 L late, and never early."""
    path = on_rail(tmp_path)
    found = inspect_model(path)
    (tmp_path / "case.toml").write_text(case_of(found, path, {}))
    asked = load_case(tmp_path / "case.toml").tolerances
    most = expected(found, SPEED).interval[1]
    assert asked.rms == pytest.approx(most, rel=0.05)
    assert asked.transition == pytest.approx(1 / 40, rel=0.05)  # half of one of twenty links
    assert asked.snap_off == pytest.approx(1.5 * most, rel=0.05)
    assert 0.02 < asked.snap_off + asked.lateness < 0.05
    assert not asked.usual() & {"rms", "transition", "snap_off", "lateness"}


def test_the_soft_end_of_a_cone_lags_more(tmp_path):
    """Its EI at the clamp is 5 times what the tip shows: as at so many times the speed."""
    path = shipped_models()["tapered-whisker"]
    cone, uniform = inspect_model(path), inspect_model(on_rail(tmp_path))
    assert hurry(uniform) == pytest.approx(1, rel=1e-6)
    assert hurry(cone) == pytest.approx(5, rel=0.01)  # 1/0.2: of a cone of 1 to 0.2, exactly
    parts = [expected(cone, speed).parts for speed in (SPEED, 2 * SPEED)]
    assert parts[0]["damping"] == pytest.approx(0.2 * cone.damping_ratio * 5 * SPEED, rel=0.01)
    assert parts[1]["speed"] == pytest.approx(2**1.5 * parts[0]["speed"])


def test_a_mocap_foot_gets_a_slide(tmp_path):
    """Past an object 12 of 60 stations chattered, and its case ended with 1."""
    key = '<keyframe><key mpos="0 0 0" mquat="1 0 0 0"/></keyframe></mujoco>'
    path = Chain(links=4).write(tmp_path)
    path.write_text(path.read_text().replace("</mujoco>", key))
    before, after = fixed(path)
    assert faults_in(before) >= {"foot"}
    assert "foot" not in faults_in(after.inspection)
    assert after.inspection.found.drive == "slide 'vibrissa-rail' with actuator 'vibrissa-motor'"


@pytest.mark.slow
def test_a_fixed_model_sweeps_as_was_expected(tmp_path):
    path = tmp_path / "tutorial.xml"
    path.write_text(shipped_models()["tutorial-chain"].read_text())
    _, after = fixed(path)
    (tmp_path / "case.toml").write_text(case_of(after.inspection.found, after.files[0], {}))
    job = load_case(tmp_path / "case.toml")
    moved = simulate_model(job.case, job.model, job.motion, job.settings)
    held = compare(solve_sweep(job.case), moved, job.tolerances)
    assert held.agrees, held.failures
    assert held.snap_off.difference < 0  # it lets go late
    worst = max(d.rms for d in held.disagreement.values())
    low, high = expected(after.inspection.found, SPEED).interval
    assert low < worst < high  # observed 2.3e-3
    assert worst < 0.01


def test_a_tapered_model_is_its_material_along_the_vibrissa():
    """A cone of steel: the mass goes with r^2, EI with r^4, within what a cell of it changes by."""
    found = inspect_model(shipped_models()["tapered-whisker"])
    for name in ("EI", "mass per length"):
        own, material = profile(found)[name]
        assert own[1:-1] == pytest.approx(material[1:-1], rel=0.1)
        assert own[1] > 5 * own[-2]
