"""Case files of sweeps in space."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from analytic import InputError
from analytic.space import solve_space
from compare import compare, read_space
from compare.align.frames import components
from compare.read.case import load_case, load_job, load_space_job

BALL = """
[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
radius = "0.25 mm"
[body]
kind = "sphere"
radius = "50 mm"
centre = ["0 mm", "70 mm", "0 mm"]
[path]
points = [["65 mm", "15 mm"], ["-75 mm", "10 mm"]]
tangent = [0.1, 1, 0]
stations = 20
"""


def loaded(text, tmp_path):
    path = tmp_path / "ball.toml"
    path.write_text(text)
    return load_case(path).case


def test_a_case_with_units_is_in_si(tmp_path):
    case = loaded(BALL, tmp_path)
    assert case.name == "ball"
    assert case.beam.length == 0.05
    assert np.allclose(case.body.centre, [0, 0.07, 0])
    assert np.allclose(case.path.corners[0], [0.065, 0, 0.015])
    assert solve_space(case).touching.sum() > 5


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('beam = "cable"', "line 15: mujoco.beam = 'cable': .* the chain's balls"),
        ("segments = 1", "line 15: mujoco.segments = 1: must be a whole number between 2"),
    ],
)
def test_what_mujoco_does_not_take_has_its_line_and_its_reason(line, said, tmp_path):
    with pytest.raises(InputError, match=said) as raised:
        loaded(f"{BALL}[mujoco]\n{line}\n", tmp_path)
    assert str(raised.value).count("must be") == 1


def test_a_prism_takes_its_contour_from_the_profile(tmp_path):
    text = """
[body]
kind = "prism"
axis = [0.2, 0.1, 1]
[profile]
kind = "catenary"
a = 0.5
c = -0.8
[path]
points = [[2.5, 0], [1, 0.2]]
"""
    assert "catenary" in loaded(text, tmp_path).body.label
    with pytest.raises(InputError, match="missing"):
        loaded(text[: text.index("[profile]")] + text[text.index("[path]") :], tmp_path)


def test_a_mesh_stands_beside_its_case_file(tmp_path):
    mesh = trimesh.creation.icosphere(2, 50.0)
    mesh.apply_translation([0, 70, 0])
    mesh.export(tmp_path / "ball.stl")
    head, tail = BALL.split("[body]")[0], BALL[BALL.index("[path]") :]
    text = f'{head}[body]\nkind = "mesh"\nfile = "ball.stl"\nscale = "1 mm"\n{tail}'
    case = loaded(text, tmp_path)
    assert np.abs(case.body.vertices).max() == pytest.approx(0.12, rel=1e-2)
    with pytest.raises(InputError, match="scale"):
        loaded(text.replace('scale = "1 mm"\n', "scale = 1\n"), tmp_path)
    for odd in ('scale = "-1 mm"', 'scale = "1 mm"\ntolerance = "-1 mm"'):
        with pytest.raises(InputError, match="must be"):
            loaded(text.replace('scale = "1 mm"', odd), tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('kind = "sphere"', 'kind = "torus"', "torus"),
        ('radius = "50 mm"', 'radius = "-50 mm"', "positive"),
        ('radius = "50 mm"', "radius = 0.05", "without a unit"),
        ('["0 mm", "70 mm", "0 mm"]', '["0 mm", "70 mm"]', "body.centre.2 = missing"),
        ("tangent = [0.1, 1, 0]", "tangent = [0, 0, 0]", "direction"),
        ("stations = 20", "stations = 1", "stations"),
        ('"70 mm", "0 mm"]', '"170 mm", "0 mm"]', "within reach"),
        ("[path]", "[way]", "path"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(old, new, says, tmp_path):
    with pytest.raises(InputError, match=says) as refused:
        loaded(BALL.replace(old, new), tmp_path)
    assert "\n" not in str(refused.value)


def test_a_case_of_the_other_kind_is_sent_to_its_command(tmp_path):
    with pytest.raises(InputError, match="vibrissa run"):
        load_space_job("catenary")
    (tmp_path / "ball.toml").write_text(BALL)
    with pytest.raises(
        InputError, match=r"body = given: must be left out in the plane; `vibrissa run`"
    ):
        load_job(str(tmp_path / "ball.toml"))


def test_limits_stand_in_the_case_file_with_their_reasons(tmp_path):
    path = tmp_path / "ball.toml"
    path.write_text(
        BALL
        + '[tolerances]\nrms = { limit = 1e-3, reason = "fine" }\n'
        + '[tolerances.moment_y]\nmax = { limit = 0.5, reason = "a weak channel" }\n'
    )
    limits = load_space_job(path).tolerances
    assert (limits.of("force_x", "rms"), limits.of("moment_y", "max")) == (1e-3, 0.5)
    assert limits.of("moment_y", "max").reason == "a weak channel"
    assert limits.of("moment_x", "max") == 3e-2
    path.write_text(BALL + '[tolerances]\nevnt = { limit = 1e-3, reason = "x" }\n')
    with pytest.raises(InputError, match=r"tolerances.evnt = unknown: must be one of .* event"):
        load_space_job(path)


def test_a_foreign_file_has_columns_units_and_a_frame_of_its_own(tmp_path):
    case = loaded(BALL, tmp_path)
    exact = solve_space(case)
    clamp = components(exact, "clamp")
    table = pd.DataFrame(
        {"X": exact.values("foot_x") * 1e3, "foot_y": exact.values("foot_y")}
        | {"foot_z": exact.values("foot_z")}
        | {name: values for name, values in clamp.items() if name != "moment_z"}
        | {"Mz": clamp["moment_z"] * 1e3}
    )
    table.to_csv(tmp_path / "other.csv", index=False, sep=";")
    columns = ["foot_x=X:mm", "moment_z=Mz:mN m"]
    read = read_space(tmp_path / "other.csv", case.beam, case.path.tangent, columns, "clamp")
    found = compare(exact, read)
    assert found.agrees
    assert max(one.max for one in found.disagreement.values()) < 1e-12
    exact.write(tmp_path / "ours.parquet")  # knows that it is in the world's frame
    ours = read_space(tmp_path / "ours.parquet", frame="clamp")
    assert compare(exact, ours).disagreement["moment_y"].max == 0
    with pytest.raises(InputError, match="beside a vibrissa with units"):
        read_space(tmp_path / "other.csv", None, None, columns)
    with pytest.raises(InputError, match="force_w"):
        read_space(tmp_path / "other.csv", case.beam, None, ["force_w=X"])


def test_the_way_is_turned_about_y(tmp_path):
    case = loaded(BALL.replace("stations = 20", "stations = 20\nturn = 90"), tmp_path)
    assert np.allclose(case.path.points, [[0.015, -0.065], [0.010, 0.075]])
