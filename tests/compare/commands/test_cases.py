"""Cases and contours that users bring, on the command line."""

import json

import pytest
import trimesh

from analytic import (
    Beam,
    Case,
    Sweep,
    circle,
    named_case,
    relative_noise,
    solve_sweep,
)
from tests.analytic.noisy import noisy
from tests.compare.command import vibrissa


@pytest.mark.slow
def test_a_real_whisker(tmp_path):
    words = ("--engine", "exact", "--stations", 60, "--out", ".")
    vibrissa("run", "whisker", *words, cwd=tmp_path).ended(0, "60 of 60 stations ok")
    found = ("reconstruct", "analytic.parquet", "--out", "found")
    vibrissa(*found, cwd=tmp_path).ended(0, "contact points from 60 stations")
    vibrissa("compare", "whisker", "analytic.parquet", "--out", "c", cwd=tmp_path).ended(0)


@pytest.mark.slow
def test_any_convex_body_lies_between_two_meshes(tmp_path):
    for name, z in (("one", 0.2), ("other", -0.2)):
        (tmp_path / f"{name}.toml").write_text(
            '[body]\nkind = "ellipsoid"\nsemi_axes = [1.0, 0.7, 1.6]\ncentre = [0, 1.1, 0]\n'
            f"[path]\npoints = [[1.5, {z}], [-1.5, {z}]]\nstations = 40\n"
        )
        words = ("run", f"{name}.toml", "--engine", "exact", "--out", name)
        vibrissa(*words, cwd=tmp_path).ended(0)
    both = [f"{name}/analytic.parquet" for name in ("one", "other")]
    done = vibrissa("reconstruct", *both, "--fit", "convex", "--out", "found", cwd=tmp_path)
    done.ended(0, "hold a convex body of")
    inner, outer = (trimesh.load(tmp_path / f"found/{x}.ply") for x in ("inner", "outer"))
    assert inner.is_watertight and outer.is_watertight
    said = json.loads((tmp_path / "found/object.json").read_text())
    assert inner.volume == pytest.approx(said["inner_volume"])
    assert outer.volume == pytest.approx(said["outer_volume"])
    assert (tmp_path / "found/object.png").exists()
    loud = vibrissa("reconstruct", *both, "--fit", "convex", "--noise", 0.05, cwd=tmp_path)
    loud.refused("in one line or plane, within noise")


def test_a_vibrissa_that_locks_itself_is_said(tmp_path):
    """Its tip climbs as it is straightened, which friction prevents: where, and why."""
    (tmp_path / "locks.toml").write_text(
        "[beam]\nnatural_curvature = 0.5\n[contact]\nfriction = 0.9\n"
        '[profile]\nkind = "parabola"\na = 0.5\nc = 0.5\n'
    )
    done = vibrissa(
        "run", "locks.toml", "--engine", "exact", "--stations", 60, "--out", "out", cwd=tmp_path
    )
    done.ended(1, "5 sticks (foot_x 1.1757 to 0.9986 L: the contact would slide back, ")
    assert len(done.stdout.splitlines()) == 2


@pytest.mark.parametrize(
    ("profile", "said"),
    [
        ('kind = "polygon"\npoints = [[-1, 1.2], [0, 0.4], [1, 1.2]]', None),
        ('kind = "points"\npoints = [[-1, 1.2], [-0.5, 0.5], [0, 0.4], [1, 1.2]]', None),
        ('kind = "mesh"\nfile = "ball.stl"\noffset = [0, 1.3]', None),
        ('kind = "points"\npoints = [[0, 1], [1, 0], [2, 0.5], [3, 0.8]]', "point 2"),
    ],
)
def test_other_contours(tmp_path, profile, said):
    trimesh.creation.icosphere(subdivisions=3).export(tmp_path / "ball.stl")
    (tmp_path / "case.toml").write_text(f"[profile]\n{profile}\n[sweep]\nstations = 20\n")
    done = vibrissa("run", "case.toml", "--engine", "exact", "--out", ".", cwd=tmp_path)
    if said is None:
        done.ended(0)
    else:
        done.refused(said)


def test_friction_is_estimated_from_the_clamp(tmp_path):
    case = named_case("rubbing")
    solve_sweep(case).with_friction(0.0).write(tmp_path / "rig.csv")
    (tmp_path / "again.csv").write_text((tmp_path / "rig.csv").read_text())
    passes = "rig.csv", "again.csv"
    done = vibrissa("reconstruct", *passes, "--friction", "auto", "--out", "found", cwd=tmp_path)
    done.ended(0, "friction coefficient 0.3000 +-")
    assert done.stdout.count("friction coefficient") == 1
    for wrong, said in (("2", "between -1 and 1"), ("much", "a number or auto")):
        words = ("reconstruct", "rig.csv", "--friction", wrong)
        vibrissa(*words, cwd=tmp_path).refused(said)


@pytest.mark.slow
def test_an_object_without_friction_is_fitted_though_its_estimate_is_below_zero(tmp_path):
    exact = solve_sweep(Case(Beam(), circle(1.0, lowest=(0.0, 0.4)), Sweep(60)))
    noisy(exact, relative_noise(exact, 0.01), 0).write(tmp_path / "rig.csv")
    options = "--friction", "auto", "--fit", "circle", "--noise", "0.01", "--out", "found"
    done = vibrissa("reconstruct", "rig.csv", *options, cwd=tmp_path)
    done.ended(0, "friction coefficient -0.00")
