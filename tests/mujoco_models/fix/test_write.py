"""A fixed copy differs from the file by its edits alone."""

import difflib

import mujoco
import pytest

from analytic import InputError
from mujoco_models.fix.edit import Edit, Insert
from mujoco_models.fix.write import fixed

MAIN = """\
<!-- of a user's own -->
<mujoco model='m'>
  <option   timestep='0.002'
            gravity="0 0 -9.81"/> <!-- metres -->
  <default>
    <geom type="capsule" size="0.001"/>
    <default class="thin"> <geom solref="0.02 1"/> </default>
  </default>
  <include file="links.xml"/>
</mujoco>
"""
LINKS = """\
<mujoco>
  <worldbody>
    <body name="foot"><site name="clamp" euler="0 0 0.3"/>
      <frame childclass="thin">
      <body name="a > b"><joint axis="0 0 1" stiffness="1"/><geom fromto="0 0 0 0 1 0"/>
        <body pos="0 1 0"><joint axis="0 0 1"/><geom fromto="0 0 0 0 1 0"/>
          <body pos="0 1 0"><joint axis="0 0 1"/><geom fromto="0 0 0 0 1 0"/></body></body></body>
      </frame>
    </body>
  </worldbody>
</mujoco>
"""


@pytest.fixture
def path(tmp_path):
    (tmp_path / "links.xml").write_text(LINKS)
    path = tmp_path / "m.xml"
    path.write_text(MAIN)
    return path


def write(path, *edits):
    model = mujoco.MjModel.from_xml_path(str(path))
    files = fixed(path, model, edits, path.with_name("fixed.xml"))
    return mujoco.MjModel.from_xml_path(str(files[0])), files


def changed(old, new):
    lines = difflib.ndiff(old.splitlines(), new.splitlines())
    return [line for line in lines if line[0] in "+-"]


def test_a_flag_is_set_where_it_is_stated_last(path):
    flags = '<option><flag override="enable"/></option><option><flag energy="enable"/></option>'
    path.write_text(MAIN.replace("<default>", f"{flags}<default>", 1))
    model, _ = write(path, Edit("flag", (("override", "disable"),), (0,)))
    assert model.opt.enableflags == mujoco.mjtEnableBit.mjENBL_ENERGY


def test_an_option_is_set_where_it_stands(path):
    model, files = write(path, Edit("option", (("timestep", "0.001"), ("integrator", "discrete"))))
    assert model.opt.timestep == 0.001
    assert changed(MAIN, files[0].read_text()) == [
        "-   <option   timestep='0.002'",
        "+   <option   timestep='0.001'",
        '-             gravity="0 0 -9.81"/> <!-- metres -->',
        '+             gravity="0 0 -9.81" integrator="discrete"/> <!-- metres -->',
    ]


def test_what_many_have_by_default_is_set_in_the_default(path):
    model, files = write(path, Edit("geom", (("solref", "0.004 1"), ("condim", "1")), (0, 1, 2)))
    assert (model.geom_solref[:, 0] == 0.004).all()
    assert (model.geom_condim == 1).all()
    assert len(files) == 1
    assert len(changed(MAIN, files[0].read_text())) == 2


def test_a_default_that_others_have_too_is_left_as_it_is(path):
    """A hand that the whisker is on would not grip without its friction."""
    links = path.with_name("links.xml")
    palm = '<geom name="palm" class="thin" type="sphere" size="1"/>'
    links.write_text(LINKS.replace("<frame", f"{palm}<frame"))
    model, _ = write(path, Edit("geom", (("condim", "1"), ("solref", "0.01 1")), (1, 2, 3)))
    assert model.geom_condim.tolist() == [3, 1, 1, 1]
    assert model.geom_solref[:, 0].tolist() == [0.02, 0.01, 0.01, 0.01]


def test_springdamper_gives_way_to_the_stiffness_that_is_set(path):
    """MuJoCo would overrule it; and the damping stays as it was."""
    links = path.with_name("links.xml")
    links.write_text(LINKS.replace('stiffness="1"', 'springdamper="0.1 1"'))
    before = mujoco.MjModel.from_xml_path(str(path))
    model, _ = write(path, Edit("joint", (("stiffness", "0.7"),), (0,)))
    assert model.jnt_stiffness.tolist() == [0.7, 0, 0]
    assert model.dof_damping == pytest.approx(before.dof_damping, rel=1e-5)


def test_what_is_replicated_is_set_in_its_one_place(path):
    links = path.with_name("links.xml")
    geom = '<geom fromto="0 0 0 0 1 0"/>'
    copies = f'<replicate count="3" offset="0 1 0">{geom}</replicate>'
    links.write_text(LINKS.replace(geom, copies, 1))
    model, files = write(path, Edit("geom", (("size", "0.5"),), (0, 1, 2)))
    assert model.geom_size[:, 0].tolist() == [0.5, 0.5, 0.5, 0.001, 0.001]
    assert len(changed(links.read_text(), files[1].read_text())) == 2


def test_an_included_file_gets_a_copy_that_the_model_includes(path):
    model, (main, links) = write(path, Edit("joint", (("stiffness", "2"),), (0,)))
    assert model.jnt_stiffness[0] == 2
    assert len(changed(LINKS, links.read_text())) == 2
    assert changed(MAIN, main.read_text()) == [
        '-   <include file="links.xml"/>', f'+   <include file="{links.name}"/>'
    ]  # fmt: skip
    assert path.read_text() == MAIN
    assert path.with_name("links.xml").read_text() == LINKS


def test_elements_that_are_lacking_are_put_in(path):
    rail = Insert('<joint name="rail" type="slide" axis="1 0 0"/>', 1)
    weight = Insert('<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>', 1)
    sensor = Insert('<sensor><force name="F" site="clamp"/></sensor>')
    model, files = write(
        path, rail, weight, sensor, Edit("site", (("quat", "1 0 0 0"), ("euler", "")), (0,))
    )
    assert model.joint("rail").type[0] == mujoco.mjtJoint.mjJNT_SLIDE
    assert model.sensor("F").id == 0
    assert model.site_quat[0].tolist() == [1, 0, 0, 0]
    assert len(files) == 2


ROBOT = """\
<mujoco>
  <asset><model name="whisker" file="links.xml"/></asset>
  <worldbody>
    <frame><attach model="whisker" body="foot" prefix="left_"/></frame>
    <body name="palm" pos="9 0 0"><attach model="whisker" body="foot" prefix="right_"/></body>
  </worldbody>
</mujoco>
"""


def test_an_attached_model_gets_a_copy_that_the_model_attaches(tmp_path):
    """Once for both places where it is attached; its classes and its sensors are its own."""
    own = LINKS.replace(
        "<worldbody>", '<default><default class="thin"><geom type="capsule" size="0.01"/></default>'
        '</default><sensor><force name="f" site="clamp" cutoff="1"/></sensor><worldbody>'
    ).replace('name="clamp"', 'name="clamp" pos="0 0 0"')  # fmt: skip
    (tmp_path / "links.xml").write_text(own)
    path = tmp_path / "m.xml"
    path.write_text(ROBOT)
    edits = (
        Edit("joint", (("stiffness", "2"),), (3,)),
        Edit("geom", (("condim", "1"),), (3, 4, 5)),
        Edit("sensor", (("cutoff", "0"),), (1,)),
    )
    model, (main, links) = write(path, *edits)
    assert model.jnt_stiffness[[0, 3]].tolist() == [2, 2]
    assert model.geom_condim.tolist() == 6 * [1]
    assert model.sensor_cutoff.tolist() == [0, 0]
    assert len(changed(ROBOT, main.read_text())) == 2 == ROBOT.count("attach ")
    assert len(changed(own, links.read_text())) == 4  # of default and sensor, and of the joint
    model = mujoco.MjModel.from_xml_path(str(path))
    with pytest.raises(InputError, match="put <site/> into a body there"):
        fixed(path, model, [Insert("<site/>", 1)], path.with_name("fixed.xml"))


def test_what_mujoco_does_not_take_is_not_left_behind(path):
    with pytest.raises(InputError, match="takes the fixed model") as caught:
        write(path, Insert("<nonsense/>"))
    assert "\n" not in str(caught.value)
    assert not path.with_name("fixed.xml").exists()
    with pytest.raises(InputError, match="another file than the model"):
        fixed(path, mujoco.MjModel.from_xml_path(str(path)), (), path)
