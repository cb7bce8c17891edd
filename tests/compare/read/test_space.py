"""Case files of sweeps in space."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from analytic import InputError
from analytic.space import solve_space
from compare import compare, read_space
from compare.align.frames import components
from compare.read.case import load_job, load_space_job
from tests.compare.case_files import BALL_OF_50_MM, WIRE

BALL = f"""
{WIRE}{BALL_OF_50_MM}[path]
points = [["65 mm", "15 mm"], ["-75 mm", "10 mm"]]
tangent = [0.1, 1, 0]
stations = 20
"""


def test_a_case_with_units_is_in_si(load):
    case = load(BALL).case
    assert case.name == "case"
    assert case.beam.length == 0.05
    assert np.allclose(case.body.centre, [0, 0.07, 0])
    assert np.allclose(case.path.corners[0], [0.065, 0, 0.015])
    assert solve_space(case).touching.sum() > 5
    turned = load(BALL.replace("stations = 20", "stations = 20\nturn = 90")).case
    assert np.allclose(turned.path.points, [[0.015, -0.065], [0.010, 0.075]])


def test_a_prism_takes_its_contour_from_the_profile(load, refused):
    body = '[body]\nkind = "prism"\naxis = [0.2, 0.1, 1]\n'
    profile = '[profile]\nkind = "catenary"\na = 0.5\nc = -0.8\n'
    path = "[path]\npoints = [[2.5, 0], [1, 0.2]]\n"
    assert "catenary" in load(body + profile + path).case.body.label
    assert "missing" in refused(body + path)


def test_a_mesh_stands_beside_its_case_file(load, refused, tmp_path):
    mesh = trimesh.creation.icosphere(2, 50.0)
    mesh.apply_translation([0, 70, 0])
    mesh.export(tmp_path / "ball.stl")
    head, tail = BALL.split("[body]")[0], BALL[BALL.index("[path]") :]
    text = f'{head}[body]\nkind = "mesh"\nfile = "ball.stl"\nscale = "1 mm"\n{tail}'
    assert np.abs(load(text).case.body.vertices).max() == pytest.approx(0.12, rel=1e-2)
    assert "scale" in refused(text.replace('scale = "1 mm"\n', "scale = 1\n"))
    for odd in ('scale = "-1 mm"', 'scale = "1 mm"\ntolerance = "-1 mm"'):
        assert "must be" in refused(text.replace('scale = "1 mm"', odd))


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('kind = "sphere"', 'kind = "torus"', "torus"),
        ('radius = "50 mm"', 'radius = "-50 mm"', "positive"),
        ('radius = "50 mm"', "radius = 0.05", "without a unit"),
        ('["0 mm", "70 mm", "0 mm"]', '["0 mm", "70 mm"]', "body.centre.2 = missing"),
        ("tangent = [0.1, 1, 0]", "tangent = [0, 0, 0]", "direction"),
        ("stations = 20", "stations = 1", "stations"),
        ('"70 mm", "0 mm"]', '"170 mm", "0 mm"]', "path = passing the "),
        ("[path]", "[way]", "path"),
        (
            "stations = 20",
            'stations = 20\n[mujoco]\nbeam = "cable"',
            "line 15: mujoco.beam = 'cable': ",
        ),
        ("stations = 20", 'stations = 20\n[mujoco]\nbeam = "cable"', "the chain's balls"),
        (
            "stations = 20",
            "stations = 20\n[mujoco]\nsegments = 1",
            "line 15: mujoco.segments = 1: ",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(refused, old, new, says):
    said = refused(BALL.replace(old, new))
    assert says in said
    assert said.count("must be") == 1


def test_a_case_of_the_other_kind_is_sent_to_its_command(tmp_path):
    with pytest.raises(InputError, match="vibrissa run"):
        load_space_job("catenary")
    (tmp_path / "ball.toml").write_text(BALL)
    with pytest.raises(
        InputError, match=r"\[body\] = given: must be a \[profile\].*`vibrissa run`"
    ):
        load_job(str(tmp_path / "ball.toml"))


def test_limits_stand_in_the_case_file_with_their_reasons(load, refused):
    limits = load(
        BALL
        + '[tolerances]\nrms = { limit = 1e-3, reason = "fine" }\n'
        + '[tolerances.moment_y]\nmax = { limit = 0.5, reason = "a weak channel" }\n'
    ).tolerances
    assert (limits.of("force_x", "rms"), limits.of("moment_y", "max")) == (1e-3, 0.5)
    assert limits.of("moment_y", "max").reason == "a weak channel"
    assert limits.of("moment_x", "max") == 3e-2
    said = refused(BALL + '[tolerances]\nevnt = { limit = 1e-3, reason = "x" }\n')
    assert "tolerances.evnt = unknown: must be one of" in said
    assert "did you mean event?" in said


def test_a_foreign_file_has_columns_units_and_a_frame_of_its_own(load, tmp_path):
    case = load(BALL).case
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
    ours = read_space(str(tmp_path / "ours.parquet"), frame="clamp")
    assert compare(exact, ours).disagreement["moment_y"].max == 0
    with pytest.raises(InputError, match="beside a vibrissa with units"):
        read_space(tmp_path / "other.csv", None, None, columns)
    with pytest.raises(InputError, match="force_w"):
        read_space(tmp_path / "other.csv", case.beam, None, ["force_w=X"])
