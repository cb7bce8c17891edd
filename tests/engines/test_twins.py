"""Twins compute MuJoCo's chain: on a smooth obstacle to rounding, on a mesh to its facets."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, circle
from engines import find_engine
from mujoco_models import Settings, simulate_sweep
from mujoco_models.obstacles.prism import Prism
from tests.engines.needs import needs, short

SMOOTH = Settings(obstacle="primitive")


@pytest.fixture(params=[("drake", "drake"), ("pinocchio", "pin")], ids=lambda twin: twin[0])
def name(request) -> str:
    """Of a twin that is there."""
    twin, distribution = request.param
    needs(distribution)
    return twin


def apart(name: str, case: Case, settings: Settings) -> tuple[dict[str, float], float]:
    """Largest difference by reading over its largest magnitude, and of the snap-off [L]."""
    twin, mujoco = find_engine(name).sweep(case, settings), simulate_sweep(case, settings)
    assert (twin.table["phase"] == mujoco.table["phase"]).all()
    assert (twin.table["status"] == mujoco.table["status"]).all()
    settled = twin.trusted & mujoco.trusted
    assert settled.mean() > 0.95
    found = {
        reading: np.abs(twin.values(reading) - mujoco.values(reading))[settled].max()
        / np.abs(mujoco.values(reading)).max()
        for reading in CLAMP_READINGS
    }
    assert np.nanmax(twin.values("discrepancy")) < 1e-6  # EI/L^2, EI/L
    return found, (twin.snap_off - mujoco.snap_off) / case.beam.length


def equals_mujoco(name: str, case: Case, segments: int) -> None:
    """A rest to 1e-8 EI/L, in either, is all that they may differ by."""
    readings, snap_off = apart(name, case, replace(SMOOTH, segments=segments))
    assert max(readings.values()) < 1e-8
    assert abs(snap_off) < 1e-9


@pytest.mark.parametrize("of", ["catenary", "parabola"])
def test_the_twin_equals_mujoco_on_a_smooth_obstacle(name, of):
    equals_mujoco(name, short(of, 40), 20)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("of", "stations", "segments"),
    [
        *(("catenary", 30, n) for n in (10, 40, 80)),
        *(("two-circles", 30, n) for n in (10, 40)),
        *(("tip-only", 30, n) for n in (20, 80)),
        ("parabola", 15, 160),  # 8,000 spheres: Drake's forces come from distances, as on a mesh
    ],
)
def test_so_it_does_with_links_of_any_size(name, of, stations, segments):
    equals_mujoco(name, short(of, stations), segments)


@pytest.mark.parametrize(
    "beam",
    [
        Beam(tip_radius=0.0035),
        Beam(natural_curvature=-0.2),
        Beam(length=0.05, flexural_rigidity=2e-6, radius=0.00025, si=True),
    ],
    ids=["cone", "curved", "in metres"],
)
def test_so_it_does_for_other_vibrissae(name, beam):
    scale = beam.length
    case = Case(beam, circle(scale, (0.0, 0.4 * scale)), clamp_stiffness=20 * beam.moment_unit)
    equals_mujoco(name, replace(case, sweep=replace(case.sweep, stations=20)), 12)


def test_a_sweep_to_the_right_is_the_mirror_image(name):
    case = short("parabola", 20)
    mirrored = case.mirrored()
    settings = replace(SMOOTH, segments=10)
    left, right = (find_engine(name).sweep(one, settings) for one in (case, mirrored))
    np.testing.assert_allclose(right.values("force_x"), -left.values("force_x"), atol=1e-12)


def test_on_a_mesh_they_differ_by_mujocos_normals(name):
    """MuJoCo keeps a mesh's vertices in single precision; a twin's normals are the facets' own.

    A tip that rests on one facet feels its normal, and the force turns with it.
    """
    case, settings = short("parabola", 30), Settings(segments=20)
    twin, mujoco = find_engine(name).sweep(case, settings), simulate_sweep(case, settings)
    tips = ((twin.table["phase"] == "tip") & twin.trusted & mujoco.trusted).to_numpy()
    assert tips.sum() > 5
    facets = Prism.of(case, settings.contour_points).facet_angles

    def off(angles):
        return np.abs(np.subtract.outer(angles, facets)).min(axis=1)

    ours, theirs = (sweep.values("contact_angle")[tips] for sweep in (twin, mujoco))
    assert np.median(off(ours)) < 1e-9
    assert 1e-7 < np.median(off(theirs)) < 1e-5
    turned = np.abs(ours - theirs).max()
    assert turned < 1e-5
    readings, snap_off = apart(name, case, settings)
    assert max(readings.values()) < 10 * turned
    assert abs(snap_off) < 1e-4
