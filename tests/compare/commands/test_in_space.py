"""What commands say of readings in space that are of no body, or of a case they do not take."""

from dataclasses import replace

import pytest

from analytic import InputError
from analytic.from_clamp.fitted import likeliest
from analytic.space import FootPath, SpatialCase, solve_space, sphere
from analytic.space.problem.readings import FORCE, MOMENT
from tests.compare.command import vibrissa

BODY = """
[beam]
length = 1.0
[body]
kind = "sphere"
radius = 1.0
centre = [0.0, 1.4, 0.0]
[path]
points = [[1.3, 0.3], [-1.5, 0.3]]
"""


@pytest.fixture(scope="module")
def swept():
    from analytic import Beam

    path = FootPath([[1.3, 0.3], [-1.5, 0.3]], stations=60)
    return solve_space(SpatialCase(Beam(), body=sphere(1.0, centre=(0, 1.4, 0)), path=path))


def turned(readings):
    """In another frame, turned by 90 degrees about z."""
    table = readings.table.copy()
    for x, y, _ in (FORCE, MOMENT):
        table[[x, y]] = table[[y, x]].to_numpy() * [1.0, -1.0]
    return replace(readings, table=table)


@pytest.mark.slow
@pytest.mark.parametrize(
    "family", ["sphere", *(pytest.param(x, marks=pytest.mark.slow) for x in ("auto", "convex"))]
)
def test_the_frame_is_the_reason_and_not_the_fit(swept, tmp_path, family):
    turned(swept).write(tmp_path / "turned.parquet")
    (tmp_path / "case.toml").write_text(BODY)
    words = ("turned.parquet", "--beam", "case.toml", "--fit", family, "--out", "o")
    done = vibrissa("reconstruct", *words, cwd=tmp_path)
    assert done.returncode in (1, 2)
    last = done.stderr.splitlines()[-1] if done.stderr else done.stdout
    assert "frame" in last or "said of the readings above" in last
    for wrong in ("take more stations", "likely edges", "check them"):
        assert wrong not in last


def test_no_family_of_bodies_is_refused_before_anything_is_written(swept, tmp_path):
    swept.write(tmp_path / "one.parquet")
    words = ("one.parquet", "--fit", "circle", "--out", "o")
    vibrissa("reconstruct", *words, cwd=tmp_path).refused("sphere, ellipsoid")
    assert not (tmp_path / "o").exists()


def test_export_asks_for_an_object_in_the_plane(tmp_path):
    (tmp_path / "case.toml").write_text(BODY)
    done = vibrissa("export", "case.toml", cwd=tmp_path)
    done.refused("case.toml: [body] = given: must be a [profile], in the plane")
    assert not (tmp_path / "whisker.xml").exists()


def test_what_could_not_be_fitted_is_named():
    def fit(name):
        raise InputError("family", name, "one that these readings determine", "sweep further")

    with pytest.raises(InputError, match=r"of 2 others the last says: family = b: .*determine"):
        likeliest("auto", ("a", "b"), fit, "edges")
