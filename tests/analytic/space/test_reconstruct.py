"""The body from six components, there and back, and what does not fit."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from analytic import Beam, InputError, Readings
from analytic.space import (
    FootPath,
    SpatialCase,
    SpatialReadings,
    ellipsoid,
    misses,
    point_cloud,
    reconstruct_space,
    solve_space,
    wrench_complaint,
    write_ply,
)
from analytic.space.from_clamp.cloud import Cloud
from analytic.space.from_clamp.reconstruct import component_noise
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE, MOMENT, NORMAL
from tests.analytic.noisy import noisy

BODY = ellipsoid((2.0, 1.4, 3.2), (0.0, 2.2, 0.0))


@pytest.fixture(scope="module")
def readings():
    path = FootPath([[3.0, 0.6], [-1.0, 0.1]], tangent=(0.1, 1, 0.05), stations=80)
    return solve_space(SpatialCase(Beam(2.0, 5.0, 0.01), body=BODY, path=path))


def changed(readings, **columns):
    table = readings.table.assign(**columns)
    return SpatialReadings(table, readings.beam, readings.tangent, "measured")


def with_noise(readings, share, seed):
    """As a sensor's, alike in x, y and z; and its standard deviations."""
    noise = {}
    for names in (FORCE, MOMENT):
        noise |= dict.fromkeys(names, share * np.nanmax(np.abs(readings.values(*names))))
    return noisy(readings, noise, seed), noise


@pytest.mark.slow
def test_exact_readings_give_the_exact_body(readings):
    found, on = reconstruct_space(readings), readings.touching
    for name in (*CONTACT_POINT, *NORMAL, "contact_arc_length"):
        assert np.abs(found[name] - readings.values(name))[on].max() < 1e-12, name
    assert (found["phase"] == readings.table["phase"])[readings.trusted].all()
    assert set(found["phase"][on]) == {"tip", "tangent"}
    missed = misses(point_cloud(found), BODY, 2.0)
    assert missed.distances.max() < 2e-12
    assert missed.angles.max() < 1e-12
    assert wrench_complaint(found) is None


def test_the_uncertainty_covers_the_true_contact(readings):
    covered, random = [], np.random.default_rng(3)
    noise = {n: 0.01 * np.nanmax(np.abs(readings.values(n))) for n in (*FORCE, *MOMENT)}
    for _ in range(6):
        found = reconstruct_space(noisy(readings, noise, random), noise)
        far = found[list(CONTACT_POINT)].to_numpy() - readings.values(*CONTACT_POINT)
        far = np.linalg.norm(far, axis=1)
        covered += list((far <= found["uncertainty"])[readings.touching & np.isfinite(far)])
    assert 0.90 < np.mean(covered) <= 1


@pytest.mark.parametrize("share", [pytest.param(3e-4, marks=pytest.mark.slow), 1e-2])
def test_free_air_is_free_whatever_the_noise(readings, share):
    """Neither stated nor seen noise is a contact, and what is clear of it is found as before."""
    on, force = readings.touching, np.linalg.norm(readings.values(*FORCE), axis=1)
    free, clear = readings.trusted & ~on, on & (force > 20 * share * np.nanmax(force))
    assert free.sum() > 10
    assert clear.sum() > 30
    for seed in range(20):
        disturbed, noise = with_noise(readings, share, seed)
        for stated in (None, noise) if seed < 2 else (None,):  # its samples take long
            found = reconstruct_space(disturbed, stated)
            assert (found["phase"] == "free")[free].all()
            assert found["torsion"].notna()[clear].all()
            assert found["contact_x"].notna()[clear].mean() > 0.95
            assert wrench_complaint(found) is None


def test_the_noise_that_is_seen_is_that_which_is_there(readings):
    exact = component_noise(readings)
    for share in (3e-4, 1e-3, 1e-2):
        ratios = []
        for seed in range(20):
            disturbed, noise = with_noise(readings, share, seed)
            seen = component_noise(disturbed)
            ratios.append([seen[n] / noise[n] for n in noise])
        assert 0.7 < np.median(ratios) < 2
    # Stations that lie apart are no noise: every sixth one still shows none.
    thin = SpatialReadings(readings.table.iloc[::6], readings.beam, readings.tangent, "thin")
    assert thin.touching.sum() < 15
    largest = np.nanmax(np.abs(readings.values(*FORCE)))
    for found in (exact, component_noise(thin)):
        assert max(found[n] for n in FORCE) < 1e-12 * largest
    stated = component_noise(readings, {"force_z": 0.1})
    assert stated["force_z"] == 0.1
    assert stated["force_x"] == exact["force_x"]


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda force, moment, _: (-force, -moment), "signs"),
        (lambda force, moment, _: (force, moment[:, ::-1]), "frame"),
        (
            lambda force, moment, tangent: (force, moment + 0.2 * _size(moment) * tangent),
            "along the clamp's tangent",
        ),
    ],
)
def test_what_no_such_vibrissa_feels_is_named(readings, change, says):
    clamp = readings.values(*FORCE), readings.values(*MOMENT)
    wrong = np.hstack(change(*clamp, readings.clamp_tangent))
    columns = dict(zip((*FORCE, *MOMENT), wrong.T, strict=True))
    assert says in wrench_complaint(reconstruct_space(changed(readings, **columns)))


def _size(vectors):
    return np.linalg.norm(vectors, axis=1)[:, None]


@pytest.mark.parametrize("share", [0.0, 0.01, 0.03])
def test_the_clamp_s_action_reversed_is_hollow(share):
    """A gentle sweep: the vibrissa could have all of these forces and moments."""
    body = ellipsoid((0.9, 0.5, 0.7), (0.0, 1.0, 0.0))
    path = FootPath([[1.4, 0.5], [-1.4, 0.5]], stations=80)
    right = solve_space(SpatialCase(Beam(radius=0.002), body=body, path=path))
    right, noise = with_noise(right, share, 1) if share else (right, None)
    assert wrench_complaint(reconstruct_space(right, noise)) is None
    names = [*FORCE, *MOMENT]
    found = reconstruct_space(changed(right, **(-right.table[names])), noise)
    assert found["contact_x"].notna().sum() > 25
    assert "hollow surface" in wrench_complaint(found)


def test_a_point_deep_inside_is_as_far_off_as_it_is_deep():
    """Along its normal, whichever way that is."""
    deep = Cloud(np.array([[0.0, 2.2 - 1.4 + 1.0, 0.0]]), np.array([[0.0, -1.0, 0.0]]))
    assert misses(deep, BODY, 1.0).distances[0] == pytest.approx(1.0, abs=1e-9)


def test_a_frame_is_wrong_beyond_noise(readings):
    """A turn of the moments about x is found beside noise of one per cent."""
    disturbed, noise = with_noise(readings, 0.01, 0)
    x, y, z = disturbed.values(*MOMENT).T
    turned = dict(zip(MOMENT, (x, -z, y), strict=True))
    found = reconstruct_space(changed(disturbed, **turned), noise)
    assert "frame" in wrench_complaint(found)


def test_friction_across_is_named(readings):
    """A fifth of the force across the plane of bending, at the same contact."""
    on = readings.touching
    force, moment = readings.values(*FORCE), readings.values(*MOMENT)
    axis = readings.values(*CONTACT_POINT) + readings.beam.radius * readings.values(*NORMAL)
    with np.errstate(invalid="ignore"):
        across = moment / _size(moment)
    force = np.where(on[:, None], force + 0.2 * _size(force) * across, force)
    moment = np.where(on[:, None], np.cross(axis - readings.values(*FOOT), force), moment)
    columns = dict(zip((*FORCE, *MOMENT), np.hstack([force, moment]).T, strict=True))
    found = reconstruct_space(changed(readings, **columns))
    assert np.nanmax(np.abs(found["along_force"])) < 1e-12
    assert "friction across" in wrench_complaint(found)


def test_a_cloud_is_a_file_that_others_read(readings, tmp_path):
    cloud = point_cloud(reconstruct_space(readings))
    path = write_ply(cloud, tmp_path / "cloud.ply")
    read = trimesh.load(path)
    assert np.abs(np.asarray(read.vertices) - cloud.points).max() < 1e-12
    with pytest.raises(InputError, match="ply"):
        write_ply(cloud, tmp_path / "cloud.xyz")


@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_readings_come_back_from_their_file(readings, suffix, tmp_path):
    path = readings.write(tmp_path / f"sweep.{suffix}")
    again = SpatialReadings.read(path)
    pd.testing.assert_frame_equal(again.table, readings.table, rtol=1e-15, check_dtype=False)
    assert again.beam == readings.beam
    assert np.array_equal(again.clamp_tangent, readings.clamp_tangent)
    assert again.provenance == dict(readings.provenance)
    with pytest.raises(InputError, match="in space"):
        Readings.read(path)


def test_readings_that_cannot_be_are_refused_in_one_line(readings, tmp_path):
    path = tmp_path / "rig.csv"
    readings.table.drop(columns="force_z").to_csv(path, index=False)
    with pytest.raises(InputError, match="add force_z"):
        SpatialReadings.read(path)
    readings.table.assign(phase="sideways").to_csv(path, index=False)
    with pytest.raises(InputError, match="line 2 of"):
        SpatialReadings.read(path)
    with pytest.raises(InputError, match="force_q"):
        reconstruct_space(readings, {"force_q": 1.0})
