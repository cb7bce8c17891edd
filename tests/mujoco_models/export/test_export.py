"""What `vibrissa export` writes is what it says: the vibrissa, and its error when it is swept."""

import re
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from analytic import Beam, Case, Sweep, circle, named_case, solve_sweep
from compare import load_case
from compare.commands.export import upwards
from compare.read.motion import first_period
from compare.simulate.inspection import Inspection
from mujoco_models import Motion, Settings, available_beams, inspect_model
from mujoco_models.export.urdf import as_urdf
from mujoco_models.export.whisker import Whisker
from tests.compare.command import vibrissa
from tests.mujoco_models.export.plain import swept, worst_rms

CIRCLE = '[profile]\nkind = "circle"\nradius = "80 mm"\nlowest = ["0 mm", "40 mm"]\n'
WIRE = f"""
[beam]
length = "100 mm"
flexural_rigidity = "6.44e-4 N m^2"
radius = "0.25 mm"
MORE
{CIRCLE}
[sweep]
stations = 60
[motion]
density = "7850 kg/m^3"
speed = 0.05
"""
NAMED = ("catenary", "two-circles", "tip-only")
CASES = {
    "wire": WIRE,
    "tapered": WIRE.replace("MORE", 'tip_radius = "0.15 mm"'),
    "curved": WIRE.replace("MORE", 'natural_curvature = "-5 1/m"'),
    "towards": WIRE.replace("MORE", 'natural_curvature = "3 1/m"'),
    "softly-held": WIRE.replace("MORE", '[support]\nrotational_stiffness = "0.05 N m/rad"'),
    "right": WIRE.replace("stations = 60", 'stations = 60\ndirection = "right"'),
    "square": WIRE.replace(
        CIRCLE,
        '[profile]\nkind = "polygon"\npoints = [["-50 mm", "90 mm"], ["-20 mm", "40 mm"], '
        '["40 mm", "50 mm"], ["20 mm", "120 mm"]]\n',
    ),
}
CASES["not-to-the-end"] = CASES["tapered"].replace(
    "stations = 60", 'stations = 60\nstop = "-80 mm"'
)
CASES = {name: text.replace("MORE", "") for name, text in CASES.items()}
beams = pytest.mark.parametrize("beam", available_beams())


def wire(**changes):
    case = Case(Beam(0.1, 6.44e-4, 2.5e-4, **changes), circle(0.08, (0, 0.04)), Sweep(60))
    return Whisker(case, Settings(segments=12, contour_points=200), Motion(speed=0.1), 0.0276)


def written(tmp_path, whisker):
    path = tmp_path / "whisker.xml"
    path.write_text(whisker.xml("A test."))
    return path


@beams
@pytest.mark.parametrize("changes", [{}, {"tip_radius": 1e-4}, {"natural_curvature": -5.0}])
def test_inspect_finds_the_vibrissa_and_no_fault(beam, changes, tmp_path):
    whisker = wire(**changes)
    whisker = replace(whisker, settings=replace(whisker.settings, beam=beam, segments=20))
    found = Inspection(inspect_model(written(tmp_path, whisker)), whisker.case.beam)
    assert found.sound, found.remarks
    assert found.found.length == pytest.approx(0.1, rel=1e-3)
    if not changes:
        assert found.found.tip_rigidity == pytest.approx(6.44e-4, rel=4e-3)
        assert found.found.period == pytest.approx(0.0276, rel=0.01)
        assert found.found.damping_ratio == pytest.approx(0.05, rel=0.02)


def test_contacts_are_as_stiff_as_stated(tmp_path):
    whisker = wire()
    geoms = inspect_model(written(tmp_path, whisker)).geoms[1:]
    assert whisker.contact_stiffness == pytest.approx(1e4 * 6.44e-4 / 0.1**3)
    for geom in geoms:
        assert geom.stiffness == pytest.approx(whisker.contact_stiffness, rel=1e-3)


@pytest.mark.filterwarnings("ignore::UserWarning")  # MuJoCo says which options it leaves behind
@beams
def test_it_is_pasted_into_a_robot(beam, tmp_path):
    whisker = wire()
    whisker = replace(whisker, settings=replace(whisker.settings, beam=beam))
    own = mujoco.MjModel.from_xml_path(str(written(tmp_path, whisker)))
    robot = tmp_path / "robot.xml"
    robot.write_text(
        '<mujoco><option timestep="0.0005" integrator="discrete"/><asset><model name="whisker" '
        'file="whisker.xml"/></asset><worldbody><body name="hand"><joint type="hinge"/><geom '
        'size="0.01"/><frame pos="0.02 0 0"><attach model="whisker" body="whisker_foot" '
        'prefix="left_"/></frame></body></worldbody></mujoco>'
    )
    by_file = mujoco.MjModel.from_xml_path(str(robot))
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="hand").add_frame().attach_body(
        mujoco.MjSpec.from_file(str(tmp_path / "whisker.xml")).body("whisker_foot"), "left_", ""
    )
    by_spec = spec.compile()
    for model, beside in ((by_file, 1), (by_spec, 0)):
        assert model.nv == own.nv - 1 + beside and model.nu == 0 and model.nsensor == 2
        bend = model.joint("left_whisker_bend3").id
        same = own.joint(bend + 1 - beside).id
        assert model.jnt_stiffness[bend] == own.jnt_stiffness[same]


def test_urdf_holds_all_but_the_springs(tmp_path):
    whisker = wire(tip_radius=1e-4)
    path = tmp_path / "whisker.urdf"
    path.write_text(as_urdf(whisker))
    model, own = mujoco.MjModel.from_xml_path(str(path)), whisker.spec().compile()
    assert model.nv == own.nv - 1 and not model.jnt_stiffness.any()
    np.testing.assert_allclose(model.dof_damping, own.dof_damping[1:], rtol=1e-6)
    links = [own.body(f"whisker_link{i}").id for i in range(1, 13)]
    np.testing.assert_allclose(model.body_mass[1:], own.body_mass[links], rtol=1e-6)
    data, same = mujoco.MjData(model), mujoco.MjData(own)
    for one in (data, same):
        one.qpos[-12:] = 0.05
        mujoco.mj_forward(one.model, one)
    np.testing.assert_allclose(data.xpos[-1], same.xpos[links[-1]], atol=1e-9)
    assert path.read_text().count("stiffness") == 13


def test_a_tube_of_a_material(tmp_path):
    (tmp_path / "wire.toml").write_text(CASES["wire"])
    done = vibrissa("export", "wire.toml", "--error", "0.1", "--speed", "0.2", "--out", "tube.xml",
                    "--material", "210 GPa,0.25 mm,0.2 mm", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = inspect_model(tmp_path / "tube.xml")
    area, second = (np.pi / k * (2.5e-4**k - 2e-4**k) * f for k, f in ((2, 2), (4, 1)))
    assert found.tip_rigidity == pytest.approx(210e9 * second, rel=0.01)
    assert found.mass == pytest.approx(7850 * area * 0.1, rel=0.06)  # but for the clamp's half cell


OTHER = next(beam for beam in available_beams() if beam != "chain")


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["--out", "whisker.txt"], r"--out = whisker.txt: must be named \*.xml or \*.urdf"),
        (["--urdf", "--obstacle"], "--obstacle = given: must be for MJCF alone"),
        (["--out", "w.urdf", "--beam", OTHER], f"--beam = {OTHER}: must be a chain in the plane"),
        (["--error", "0"], "--error = 0.0: must be between 0 and 1"),
        (["--material", "210 GPa"], "--material = '210 GPa': must be two or three values"),
        (["--material", "2e11,1e-4,2e-4"], "--material = .*: must be with radii"),
        (["--density", "heavy"], "quantity = 'heavy': must be a finite number with a unit"),
        pytest.param(
            ["--speed", "2"],
            "--error = 0.01: must be at least .* at 2 L/T1; ask for a larger error",
            marks=pytest.mark.slow,
        ),
        (["--error", "0.0006"], "--error = 0.0006: must be above 0.0006, .*ask for a larger error"),
    ],
)
def test_what_cannot_be_written_is_a_line(words, line, tmp_path):
    (tmp_path / "wire.toml").write_text(CASES["wire"])
    done = vibrissa("export", "wire.toml", *words, cwd=tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert re.match(f"vibrissa: {line}", done.stderr), done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", [*NAMED, *CASES])
def test_what_is_written_meets_the_error(name, tmp_path):
    """The closed form is no part of the choice, only of this.

    From corner to corner of a square the contact jumps, and in motion late: 0.014 is the least.
    """
    exported(name, "chain", tmp_path, 0.03 if name == "square" else 0.01)


@pytest.mark.slow
@pytest.mark.parametrize(("error", "speed"), [(0.01, 0.05), (0.003, 0.02)])
def test_past_a_primitive_it_meets_the_error(error, speed, tmp_path):
    """It has one contact a link: with links enough for two, it was 1.5 times as far off."""
    case, stated = exported("wire", "chain", tmp_path, error, speed)
    spec = mujoco.MjSpec.from_file(str(tmp_path / "whisker.xml"))
    (mesh,) = (g for g in spec.geoms if g.type == mujoco.mjtGeom.mjGEOM_MESH)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.08, 0.05, 0],
                            pos=[0, 0.12, 0], contype=mesh.contype,
                            conaffinity=mesh.conaffinity)  # fmt: skip
    spec.delete(mesh)
    spec.compile()
    (path := tmp_path / "past.xml").write_text(spec.to_xml())
    off = worst_rms(solve_sweep(case), swept(path, case, speed, first_period(case.beam, 7850)))
    assert off < stated


@pytest.mark.slow
@beams
def test_every_beam_meets_the_error(beam, tmp_path):
    exported("not-to-the-end" if beam == "cable" else "tapered", beam, tmp_path, 0.01)


@pytest.mark.slow
@pytest.mark.skipif("cable" not in available_beams(), reason="MuJoCo 4 has no cables")
def test_a_cable_slips_off_sideways_before_the_end(tmp_path):
    """It bends in all directions; without friction nothing holds it where the object recedes."""
    (tmp_path / "case.toml").write_text(CASES["tapered"])
    done = vibrissa("export", "case.toml", "--beam", "cable", cwd=tmp_path)
    assert done.returncode == 2 and "slip off sideways" in done.stderr


def exported(name, beam, folder, error, speed=0.05):
    case = replace(named_case(name), sweep=Sweep(60)) if name in NAMED else None
    given, period = name, 1.0
    if case is None:
        given = "case.toml"
        (folder / given).write_text(CASES[name])
        case = load_case(folder / given).case
        period = first_period(case.beam, 7850)
    done = vibrissa("export", given, "--obstacle", "--speed", speed, "--beam", beam,
                    "--error", error, cwd=folder)  # fmt: skip
    assert done.returncode == 0, done.stderr
    off = worst_rms(solve_sweep(case), swept(folder / "whisker.xml", case, speed, period))
    (stated,) = re.findall(r": (\S+) rms at most", done.stdout)
    assert off < float(stated) <= error
    return case, float(stated)


def test_a_bound_is_rounded_up_and_only_if_it_must_be():
    """Not by what binary digits lack: 60 times 1e-4 is more than 6e-3."""
    for digits in range(10, 100):
        for power in range(-8, 1):
            exact = float(f"{digits}e{power}")
            assert float(upwards(exact)) == exact
            assert float(upwards(exact * (1 + 1e-9))) == float(f"{digits + 1}e{power}")
