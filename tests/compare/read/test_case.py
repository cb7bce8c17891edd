"""Case files: what they may not hold, and where it stands."""

import math
import time

import numpy as np
import pytest
import trimesh

from analytic import InputError, named_case
from compare.read.case import load_job
from compare.read.toml import TomlFile

CIRCLE = '[profile]\nkind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]\n'
UNITED = """[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
[profile]
kind = "circle"
radius = "40 mm"
lowest = [0, "20 mm"]
"""
REAL = UNITED.replace(
    "[profile]",
    'natural_curvature = "-6 1/m"\n[support]\nrotational_stiffness = "5.585e-3 mN m/deg"\n'
    "[contact]\nfriction = 0.2\n[profile]",
)
TABLED = UNITED.replace('"2e-6 N m^2"', '[["0 mm", "2 N mm^2"], ["50 mm", "1e-6 N m^2"]]').replace(
    "[profile]", 'natural_curvature = [[0, "-6 1/m"], ["50 mm", 0]]\n[profile]'
)


@pytest.mark.parametrize(
    ("said", "instead", "line"),
    [
        ("radius = 1.0", "radios = 1.0", 7),
        ("radius = 1.0", 'radius = "20 kg"', 7),
        ("lowest = [0.0, 0.4]", "lowest = [0.0, 0.4, 1.0]", 8),
    ],
)
def test_what_is_wrong_in_one_of_several_objects_is_named_by_its_line(
    said, instead, line, tmp_path
):
    """That of the first object was named, or none."""
    path = tmp_path / "two.toml"
    objects = [CIRCLE, CIRCLE.replace(said, instead)]
    path.write_text("".join(objects).replace("[profile]", "[[profile]]"))
    with pytest.raises(InputError, match=f"two.toml, line {line}: profile"):
        load_job(path)


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        ("[sweep]\nstart = -2.5\n", "line 6: sweep.start = -2.5: must be"),
        ("[mujoco]\nsegments = true\n", "line 6: mujoco.segments = True"),
        ('[contact]\nfriction = "0.2"\n', "must be a number; write it without quotes and without"),
        ('[beam]\nlength = "9**9**9 m"\n', "line 6: beam.length = '9**9**9 m'"),
        ("[beam]\nlength = 0x" + "f" * 5000, "line 6 = a number of 309 digits or more"),
        ("x = " + "9" * 5000, "309 digits"),
        ("x = " + "[" * 5000 + "]" * 5000, "levels deep"),
        (".".join("a" * 5000) + " = 1", "must be"),
        ("".join(f"k{i} = 1\n" for i in range(20_000)), "keys"),
        ("#" * 3_000_000, "MB"),
    ],
)
def test_values_that_cannot_be(refused, extra, said):
    assert said in refused(CIRCLE + extra)


@pytest.mark.parametrize("name", ["../../x", "a\\\\b", ".x", "x" * 200])
def test_a_name_stays_in_its_folder(refused, name):
    assert "line 1: name" in refused(f'name = "{name}"\n{CIRCLE}')


def test_a_mark_of_byte_order_is_none_of_the_text(load):
    assert load("\ufeff" + CIRCLE).case.digest == load(CIRCLE).case.digest


def test_files_that_are_none(refused, tmp_path):
    assert "UTF-8" in refused(CIRCLE.encode("utf-16"))
    assert "valid TOML" in refused(CIRCLE.replace("\n", "\r"))
    assert "in quotes" in refused("[beam]\nlength = 5 cm\n")
    for name in (f"{tmp_path}/case.toml/", str(tmp_path), "/dev/zero"):
        with pytest.raises(InputError):
            load_job(name)


def test_the_place_of_an_error_takes_no_longer_than_the_file(refused):
    """It took 400 s beside 5,000 points; the limit is loose, for busy machines."""
    points = "".join(f"  [{x}, {x}], # ] here is one\n" for x in range(20_000))
    begin = time.process_time()
    said = refused(f'[profile]\nkind = "points"\npoints = [\n{points}]\nradis = 1\n')
    assert "line 20005: profile.radis" in said
    assert time.process_time() - begin < 10


def test_the_line_of_a_key_however_it_is_written(tmp_path):
    path = tmp_path / "some.toml"
    path.write_text(
        '# [a]\na.b = 1\n"c d" = """\n[x]\n"""\n[t]\nlist = [ # [\n  1,\n]\n'
        "inner = { one = 1, two = { three = 3 } }\n[t.u]\nv = ']'\n[[w]]\nz = 1\n[[w]]\nz = 2\n"
    )
    place = TomlFile.read(path, "file").place
    lines = {"a.b": 2, "c d": 3, "t": 6, "t.list.0": 7, "t.inner.two.three": 10, "t.u.v": 12,
             "t.u.missing": 11, "w": 13}  # fmt: skip
    for keys, line in lines.items():
        assert place(keys.split(".")) == f"{path}, line {line}: {keys}"
    assert place(["nowhere"]) == f"{path}: nowhere"


def test_units_are_mixed_only_where_the_scale_has_one(load, refused):
    scaled = UNITED[: UNITED.index('"circle"')] + '"catenary"\na = 0.5\nc = -0.8\n'
    assert load(scaled + 'scale = "5 cm"\n').case.beam.length == pytest.approx(0.05)
    assert "line 6: profile.a = without a unit" in refused(scaled)


def test_a_mesh_without_a_scale_beside_units(load, refused, tmp_path):
    """Its numbers are metres: far out of reach if they were millimetres."""
    trimesh.creation.icosphere(subdivisions=2, radius=20).export(tmp_path / "ball.stl")
    mesh = UNITED[: UNITED.index('"circle"')] + '"mesh"\nfile = "ball.stl"\noffset = [0, "45 mm"]\n'
    assert 'scale = "1 mm"' in refused(mesh)
    assert load(mesh + 'scale = "1 mm"\nhull = true\n').case.beam.si


def test_what_is_not_in_the_paper_has_keys(load):
    case = load(REAL).case
    assert (case.beam.natural_curvature, case.friction) == (-6.0, 0.2)
    assert case.clamp_stiffness == pytest.approx(5.585e-6 * 180 / math.pi)
    assert load(CIRCLE + "[support]\n[contact]\n").case.is_plain
    contour = load('[profile]\nkind = "two-circles"\n').case.profile
    assert contour.label == named_case("two-circles").profile.label
    beam = load(TABLED).case.beam
    assert beam.varies
    np.testing.assert_allclose(beam.rigidity_at([0.0, 0.05]), [2e-6, 1e-6])
    np.testing.assert_allclose(beam.curvature_at([0.0, 0.025, 0.05]), [-6, -3, 0], atol=1e-12)
    cone = UNITED.replace("[profile]", 'radius = "0.2 mm"\ntip_radius = "20 um"\n[profile]')
    assert load(cone).case.beam.tip_radius == pytest.approx(2e-5)


@pytest.mark.parametrize(
    ("text", "old", "new", "said"),
    [
        (UNITED, 'flexural_rigidity = "2e-6 N m^2"\n', "", "line 1: beam.flexural_rigidity = miss"),
        (UNITED, 'length = "50 mm"\n', "radius = 1\n", "line 2: beam.radius = without a unit"),
        (UNITED, UNITED[UNITED.index('"circle"') :], '"two-circles"', "profile.right_radius = mis"),
        (UNITED, '"50 mm"', '"50 mmm"', "a known unit of length, as '50 mm'"),
        (UNITED, '[0, "20 mm"]', '["20 mm"]', "line 7: profile.lowest.1 = missing"),
        (UNITED, '"40 mm"', '"-4 cm"', "line 6: profile.radius in SI units = -0.04: must be"),
        (UNITED, '"circle"', '"cirle"', "did you mean circle?"),
        (REAL, "0.2", "-0.2", "line 8: contact.friction = -0.2: must be greater than or equal to"),
        (REAL, '"5.585e-3 mN m/deg"', "5.0", "line 6: support.rotational_stiffness = without a un"),
        (REAL, "mN m/deg", "mN", "a known unit of moment by angle, as '0.3 mN m/rad'"),
        (REAL, "5.585e-3", "1e-9", "a hundredth of EI/L"),
        (REAL, "-6 1/m", "-70 1/m", "curved back to the foot line"),
        (REAL, "friction", "mu", "line 8: contact.mu = 0.2: must be one of the keys friction"),
        (TABLED, ', "1e-6 N m^2"', "", "a list of pairs [arc length from the clamp, force times"),
        (TABLED, "1e-6 N m^2", "-1e-6 N m^2", "positive all along"),
        (
            TABLED,
            '["50 mm", "1e-6',
            '["40 mm", "1e-6',
            "from the clamp, s = 0, to the tip, s = 0.0",
        ),
    ],
)
def test_what_beside_units_and_in_these_keys_cannot_be(refused, text, old, new, said):
    assert old in text
    assert said in refused(text.replace(old, new))
