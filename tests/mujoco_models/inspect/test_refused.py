"""What is no model of a vibrissa is a line."""

import random
import re

import pytest

from analytic import InputError
from mujoco_models import inspect_model
from tests.fuzz.models import drawn_urdf
from tests.mujoco_models.inspect.chains import Chain
from tests.mujoco_models.inspect.test_inspect import END, TWO, measured


def test_a_urdf_is_a_model_too(tmp_path):
    """URDF has no springs, so that nothing holds its joints; it says so in a line."""
    (tmp_path / "w.urdf").write_text(drawn_urdf(random.Random(0)))
    with pytest.raises(InputError, match="without a stiffness"):
        inspect_model(tmp_path / "w.urdf")


@pytest.mark.parametrize(
    ("chain", "names", "said"),
    [
        (Chain(), {"foot": "whisker-fot"}, "did you mean whisker-foot?"),
        (Chain(), {"force": "T"}, "it is no <force>"),
        (Chain(), {"torque": "X"}, "torque sensor of the model = 'X'"),
        (Chain(), {"geoms": "hair*"}, "geoms of the model = 'hair\\*'"),
        (Chain(), {"foot": "whisker5"}, "without a vibrissa where the names say"),
        (Chain(links=2), {}, "without a vibrissa: must be with a row of at least 3"),
        (Chain(stiffer={4: 0.0}), {}, "body 'whisker4' of the vibrissa = without a stiffness"),
        (Chain(rigidity=0.0), {}, "without a stiffness"),
        (Chain(beside=TWO.replace('name="clamp"', 'name="c2"')), {}, "2 candidates"),
        (Chain(sensors='<force name="F" site="clamp"/>' * 2), {}, "repeated name"),
        (
            Chain(sensors='<force name="F" site="clamp"/><force name="G" site="clamp"/>'),
            {},
            "2 force sensors \\('F', 'G'\\)",
        ),
        (Chain(beside='<geom type="mesh" mesh="none"/>'), {}, "correct the file"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path, chain, names, said):
    with pytest.raises(InputError, match=said) as caught:
        measured(tmp_path, chain, **names)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("suffix", [".txt", ".XML", ".mjcf", ".mjb"])
def test_a_name_by_which_mujoco_reads_no_file_is_refused(tmp_path, suffix):
    path = Chain().write(tmp_path)
    with pytest.raises(InputError, match=r"named \*\.xml or \*\.urdf; rename it"):
        inspect_model(path.rename(path.with_suffix(suffix)))


COUPLED = '<equality><joint joint1="j2" joint2="j1"/><joint joint1="j3" joint2="j1"/></equality>'


TENDON = (
    '<tendon><fixed name="t"><joint joint="rail" coef="1"/></fixed></tendon>'
    '<actuator><position tendon="t" kp="1e3"/></actuator>'
)


RAIL = Chain(foot="", inside_foot='<joint name="rail" type="slide" axis="1 0 0"/>')


NAMED = [("<joint axis", f'<joint name="j{i}"  axis', 1) for i in range(1, 5)]


@pytest.mark.parametrize(
    ("chain", "changes", "said"),
    [
        (Chain(links=4), [*NAMED, (END, COUPLED + END)], "held by an equality constraint"),
        (RAIL, [(END, TENDON + END)], "'rail' of the foot = held by a tendon's actuator"),
        (Chain(), [('axis="0 0 1"', 'axis="0 1 0"')], "hinges of the vibrissa = along it"),
        # As those of tails of animals: MuJoCo's suite has dogs and rodents with such.
        (
            Chain(),
            [('pos="0 0.05 0"><joint axis="0 0 1"', 'pos="0 0.05 0"><joint axis="1 0 0"', 3)],
            "'whisker2' .* = without a bend in the plane",
        ),
    ],
)
def test_what_is_coupled_held_or_turned_is_no_beam(tmp_path, chain, changes, said):
    with pytest.raises(InputError, match=said) as caught:
        measured(tmp_path, chain, *changes)
    assert "\n" not in str(caught.value)


ROPE = '<tendon><spatial name="t">PATH</spatial></tendon>'


@pytest.mark.parametrize(
    "tendon",
    [
        '<tendon><spatial stiffness="50">PATH</spatial></tendon>',
        '<tendon><spatial range="0.95 1.1">PATH</spatial></tendon>',
        f'{ROPE}<equality><tendon tendon1="t"/></equality>',
        f'{ROPE}<actuator><motor tendon="t"/></actuator>',
    ],
)
def test_a_tendon_that_holds_it_is_named(tmp_path, tendon):
    chain = Chain(tip='/><site name="tip" pos="0 0.02 0"')
    rope = tendon.replace("PATH", '<site site="clamp"/><site site="tip"/>')
    with pytest.raises(InputError, match="body 'whisker20' of the vibrissa = held by a tendon"):
        measured(tmp_path, chain, (END, rope + END))
    measures = rope.split("<equality>")[0].split("<actuator>")[0]
    for acts in ('stiffness="50"', 'range="0.95 1.1"'):
        measures = measures.replace(acts, "")
    found = measured(tmp_path, chain, (END, measures + END))
    assert found.tip_rigidity == pytest.approx(1, rel=1e-3)


def test_a_tendon_on_a_joint_that_pulls_to_one_side_is_no_spring_of_it(tmp_path):
    """By its mean to both sides it had half its stiffness, and no fault where EI tapers."""
    joint = ("<joint axis", '<joint name="j" axis', 1)
    tendon = '<tendon><fixed stiffness="20" springlength="{}"><joint joint="j" coef="1"/>'
    both, one = (f"{tendon.format(at)}</fixed></tendon>{END}" for at in ("0", "-1 0"))
    first = measured(tmp_path, Chain(), joint, (END, both)).joints[0]
    assert first.compliance == pytest.approx(1 / 40)
    with pytest.raises(InputError, match="'whisker1' of the vibrissa = held by a tendon"):
        measured(tmp_path, Chain(), joint, (END, one))


def test_a_link_at_an_end_without_a_geom_is_named(tmp_path):
    """Its end is not known: it was taken for that of the link before, which it turns back to."""
    path = Chain().write(tmp_path)
    body = '<inertial pos="0 0 0" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/>'
    path.write_text(re.sub('<geom name="whisker-geom20" [^>]*>', body, path.read_text()))
    with pytest.raises(InputError, match="'whisker20' of the vibrissa = without a geom"):
        inspect_model(path)
    with pytest.raises(InputError, match="'whisker1' of the vibrissa = without a geom"):
        measured(tmp_path, geoms="whisker-geom2?,whisker-geom?5,whisker-geom20")


def test_what_is_no_model(tmp_path):
    (tmp_path / "x.xml").write_text("<mujoco><worldbody></mujoco>")
    for path in (tmp_path / "x.xml", tmp_path / "missing.xml", tmp_path):
        with pytest.raises(InputError) as caught:
            inspect_model(path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("stiffness", "said"),
    [(-1.0, "'whisker5' of the vibrissa = pushed away"), (1e300, "'whisker5' .* = so stiff")],
)
def test_a_joint_without_a_usable_stiffness_is_named(tmp_path, stiffness, said):
    with pytest.raises(InputError, match=said):
        inspect_model(Chain(stiffer={5: stiffness}).write(tmp_path))


@pytest.mark.parametrize("mass", ["1e300", "1e-290"])
def test_masses_without_vibrations_are_a_line(tmp_path, mass):
    first = 'fromto="0 0 0 0 0.05 0" mass="'
    with pytest.raises(InputError, match=r"mass|first period"):
        measured(tmp_path, Chain(), (first, f'{first}{mass}" user="', 1))
