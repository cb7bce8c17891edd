"""Case files: what they may not hold, and where it stands."""

import math
import time

import numpy as np
import pytest

from analytic import InputError
from compare.read.case import load_job
from compare.read.toml import TomlFile

CIRCLE = '[profile]\nkind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]\n'


def refused(tmp_path, content) -> str:
    path = tmp_path / "case.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as error:
        load_job(str(path))
    message = str(error.value)
    assert "\n" not in message
    assert len(message) < 600
    return message


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        ("[beam]\nlength = true\n", "line 6: beam.length = True"),
        ("[sweep]\nstations = true\n", "line 6: sweep.stations = True"),
        ('[sweep]\nstations = "200"\n', "line 6: sweep.stations = '200'"),
        ("[mujoco]\nsegments = 2.5\n", "line 6: mujoco.segments = 2.5"),
        ("[mujoco]\nsegments = true\n", "line 6: mujoco.segments = True"),
        ("[mujoco]\nplanar = 1\n", "line 6: mujoco.planar = 1"),
        ("[sweep]\nstations = 99999999999999999999\n", "sweep.stations"),
        ("[beam]\nlength = 1e308\n", "beam.length = 1e+308"),
        ("[beam]\nlength = 0x" + "f" * 5000, "line 6 = a number of 309 digits or more"),
        ('[beam]\nlength = "9**9**9 m"\n', "line 6: beam.length = '9**9**9 m'"),
        ("x = " + "9" * 5000, "309 digits"),
        ("x = " + "[" * 5000 + "]" * 5000, "levels deep"),
        (".".join("a" * 5000) + " = 1", "levels deep"),
        ("".join(f"k{i} = 1\n" for i in range(20_000)), "keys"),
    ],
)  # fmt: skip
def test_values_that_cannot_be(tmp_path, extra, said):
    assert said in refused(tmp_path, CIRCLE + extra)


@pytest.mark.parametrize("name", ["../../x", "a/b", "a\\\\b", "", ".", "..", ".x", "x" * 200])
def test_a_name_stays_in_its_folder(tmp_path, name):
    assert "line 1: name" in refused(tmp_path, f'name = "{name}"\n{CIRCLE}')


def test_files_that_are_none(tmp_path):
    assert "UTF-8" in refused(tmp_path, CIRCLE.encode("utf-16"))
    assert "valid TOML" in refused(tmp_path, CIRCLE.replace("\n", "\r"))
    assert "MB" in refused(tmp_path, CIRCLE + "#" * 3_000_000)
    for name in (f"{tmp_path}/case.toml/", str(tmp_path), "/dev/zero"):
        with pytest.raises(InputError):
            load_job(name)


def test_the_place_of_an_error_takes_no_longer_than_the_file(tmp_path):
    """It took 400 s beside 5,000 points; the limit is loose, for busy machines."""
    points = "".join(f"  [{x}, {x}], # ] here is one\n" for x in range(20_000))
    text = f'[profile]\nkind = "points"\npoints = [\n{points}]\nradis = 1\n'
    begin = time.process_time()
    assert "line 20005: profile.radis" in refused(tmp_path, text)
    assert time.process_time() - begin < 10


def test_the_line_of_a_key_however_it_is_written(tmp_path):
    path = tmp_path / "some.toml"
    path.write_text(
        '# [a]\na.b = 1\n"c d" = """\n[x]\n"""\n[t]\nlist = [ # [\n  1,\n]\n'
        "inner = { one = 1, two = { three = 3 } }\n[t.u]\nv = ']'\n[[w]]\nz = 1\n[[w]]\nz = 2\n"
    )
    place = TomlFile.read(path, "file").place
    for keys, line in (
        (["a", "b"], 2),
        (["c d"], 3),
        (["t"], 6),
        (["t", "list", "0"], 7),
        (["t", "inner", "two", "three"], 10),
        (["t", "u", "v"], 12),
        (["t", "u", "missing"], 11),
        (["w"], 13),
    ):
        assert place(keys) == f"{path}, line {line}: {'.'.join(keys)}"
    assert place(["nowhere"]) == f"{path}: nowhere"


def test_units_are_mixed_only_where_the_scale_has_one(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(
        '[beam]\nlength = "50 mm"\nflexural_rigidity = "2e-6 N m^2"\n'
        '[profile]\nkind = "catenary"\na = 0.5\nc = -0.8\nscale = "5 cm"\n'
    )
    assert load_job(str(path)).case.beam.length == pytest.approx(0.05)
    mixed = path.read_text().replace('scale = "5 cm"', "")
    assert "line 6: profile.a = without a unit" in refused(tmp_path, mixed)


UNITED = """[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
[profile]
kind = "circle"
radius = "40 mm"
lowest = [0, "20 mm"]
"""


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('flexural_rigidity = "2e-6 N m^2"\n', ""), "line 1: beam.flexural_rigidity = missing"),
        (('length = "50 mm"\n', ""), "line 1: beam.length = missing"),
        ((UNITED[: UNITED.index("[profile]")], ""), "beam.length = missing"),
        ((UNITED[UNITED.index('"circle"') :], '"two-circles"\n'), "profile.right_radius = missing"),
        (('"50 mm"', '"50 mmm"'), "a known unit of length, as '50 mm'"),
        (('"2e-6 N m^2"', '"2 N"'), "as '2 N mm^2'"),
        (('lowest = [0, "20 mm"]', 'lowest = "20 mm"'), "profile.lowest = '20 mm': must be a list"),
        (('lowest = [0, "20 mm"]', 'lowest = ["20 mm"]'), "line 7: profile.lowest.1 = missing"),
        (
            ('"circle"\nradius = "40 mm"', '"ellipse"\nsemi_axes = "30 mm"'),
            "profile.semi_axes = '30 mm': must be a list",
        ),
    ],
)
def test_beside_units_nothing_is_one_by_default(tmp_path, change, said):
    assert change[0] in UNITED
    assert said in refused(tmp_path, UNITED.replace(*change))


def test_a_mesh_without_a_scale_beside_units(tmp_path):
    """Its numbers are metres: far out of reach if they were millimetres."""
    import trimesh

    trimesh.creation.icosphere(subdivisions=2, radius=20).export(tmp_path / "ball.stl")
    mesh = UNITED[: UNITED.index('"circle"')] + '"mesh"\nfile = "ball.stl"\noffset = [0, "45 mm"]\n'
    assert 'scale = "1 mm"' in refused(tmp_path, mesh)
    path = tmp_path / "case.toml"
    path.write_text(mesh + 'scale = "1 mm"\nhull = true\n')
    assert load_job(str(path)).case.beam.si


REAL = UNITED.replace(
    "[profile]",
    'natural_curvature = "-6 1/m"\n[support]\nrotational_stiffness = "5.585e-3 mN m/deg"\n'
    "[contact]\nfriction = 0.2\n[profile]",
)


def test_friction_clamp_and_natural_curvature_have_keys(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(REAL)
    case = load_job(str(path)).case
    assert (case.beam.natural_curvature, case.friction) == (-6.0, 0.2)
    assert case.clamp_stiffness == pytest.approx(5.585e-6 * 180 / math.pi)
    path.write_text(CIRCLE + "[support]\n[contact]\n")
    assert load_job(str(path)).case.is_plain


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("0.2", "-0.2"), "line 8: contact.friction = -0.2: must be greater than or equal to 0"),
        (("0.2", "1.5"), "line 8: contact.friction = 1.5"),
        (("0.2", "nan"), "line 8: contact.friction = nan"),
        (('"5.585e-3 mN m/deg"', "5.0"), "line 6: support.rotational_stiffness = without a unit"),
        (("mN m/deg", "mN"), "a known unit of moment by angle, as '0.3 mN m/rad'"),
        (("5.585e-3", "0"), "line 6: support.rotational_stiffness"),
        (("5.585e-3", "-1"), "line 6: support.rotational_stiffness"),
        (("5.585e-3", "1e-9"), "a hundredth of EI/L"),
        (('"-6 1/m"', "-6"), "line 4: beam.natural_curvature = without a unit"),
        (('"-6 1/m"', "inf"), "beam.natural_curvature"),
        (("-6 1/m", "-40 1/m"), "overhangs"),
        (("-6 1/m", "-70 1/m"), "curved back to the foot line"),
        (("friction", "mu"), "line 8: contact.mu = 0.2: must be one of the keys friction"),
    ],
)
def test_what_these_keys_may_not_hold(tmp_path, change, said):
    assert change[0] in REAL
    assert said in refused(tmp_path, REAL.replace(*change))


TABLED = UNITED.replace('"2e-6 N m^2"', '[["0 mm", "2 N mm^2"], ["50 mm", "1e-6 N m^2"]]').replace(
    "[profile]", 'natural_curvature = [[0, "-6 1/m"], ["50 mm", 0]]\n[profile]'
)


def test_what_varies_along_the_vibrissa_is_a_table(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(TABLED)
    beam = load_job(str(path)).case.beam
    assert beam.varies
    np.testing.assert_allclose(beam.rigidity_at([0.0, 0.05]), [2e-6, 1e-6])
    np.testing.assert_allclose(beam.curvature_at([0.0, 0.025, 0.05]), [-6, -3, 0], atol=1e-12)
    path.write_text(
        UNITED.replace("[profile]", 'radius = "0.2 mm"\ntip_radius = "20 um"\n[profile]')
    )
    assert load_job(str(path)).case.beam.tip_radius == pytest.approx(2e-5)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((', "1e-6 N m^2"', ""), "line 3: beam.flexural_rigidity"),
        ((', "1e-6 N m^2"', ""), "a list of pairs [arc length from the clamp, force times length"),
        (("1e-6 N m^2", "1e-6 N"), "a known unit of force times length squared"),
        (('"1e-6 N m^2"', "1e-6"), "line 3: beam.flexural_rigidity = without a unit"),
        (("1e-6 N m^2", "-1e-6 N m^2"), "positive all along"),
        (('["50 mm", "1e-6', '["40 mm", "1e-6'), "from the clamp, s = 0, to the tip, s = 0.05"),
        (('natural_curvature = [[0, "-6 1/m"], ["50 mm", 0]]', 'tip_radius = "-1 um"'), "between"),
        (('"-6 1/m"', '"-90 1/m"'), "overhangs"),
    ],
)
def test_what_these_tables_may_not_hold(tmp_path, change, said):
    assert change[0] in TABLED
    assert said in refused(tmp_path, TABLED.replace(*change))
