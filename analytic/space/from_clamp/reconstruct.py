"""The body from the clamp's six components, in closed form."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from analytic.from_clamp.contact import LONGEST, UNLOADED, contact_bent_right
from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import is_finite_number
from analytic.problem.support import require_plain
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)

_SAMPLES = 400  # of the noise, a station
_COVERAGE = 0.95
_EXACT = 1e-9  # sine of an angle: what rounding leaves of one that vanishes
_EXPLAINED = 4.0  # standard deviations that noise may explain
_SUSPICIOUS = 0.02  # share of the moment that must not be there, in the median of a sweep
_COMPONENTS = (*FORCE, *MOMENT)


def reconstruct_space(
    readings: SpatialReadings, noise: Mapping[str, float] | None = None, seed: int = 0
) -> pd.DataFrame:
    """Contact points, normals, phase and arc length from foot position, force and moment.

    The force is along the body's normal, and the vibrissa bends in the plane of force and clamp
    tangent, where the planar closed form has the contact (Will, Steigenberger and Behn, 2014,
    section 5).

    Parameters
    ----------
    readings : SpatialReadings
        Only the nine sensed columns are used, and status.
    noise : mapping, optional
        Standard deviations of the six components by name, each in its unit; exact if not given.
    seed : int
        Of the sampled noise.

    Returns
    -------
    pandas.DataFrame
        A row a station: ``contact_*`` [length] on the body's surface, ``normal_*``,
        ``contact_arc_length`` [length], ``phase``; ``uncertainty`` [length], the distance within
        which the true contact lies in 95 % of all cases; ``torsion`` and ``along_force``, the parts
        of the moment along the clamp's tangent and along the force, over its magnitude. Both vanish
        for a straight isotropic vibrissa without friction. NaN where nothing touches or no vibrissa
        has such readings; ``phase`` is ``"free"`` there.

    Raises
    ------
    InputError
        If the vibrissa is not straight and uniform, or the noise is none of the components'.
    """
    beam, tangent = readings.beam, readings.clamp_tangent
    require_plain("the reconstruction in space", beam, np.inf, 0.0)
    foot = readings.values(*FOOT) / beam.length
    force = readings.values(*FORCE) / beam.force_unit
    moment = readings.values(*MOMENT) / beam.moment_unit
    felt = readings.trusted & (np.linalg.norm(force, axis=1) > UNLOADED)
    deviation = _deviations(noise) / np.repeat([beam.force_unit, beam.moment_unit], 3)

    radius = beam.radius / beam.length
    points = np.full((len(foot), 3), np.nan)
    normals, arc_length = points.copy(), np.full(len(foot), np.nan)
    torsion, along_force, uncertainty = (arc_length.copy() for _ in range(3))
    phase = np.full(len(foot), "free", dtype=object)
    if felt.any():
        found = _contacts(foot[felt], force[felt], moment[felt], tangent, radius)
        there = (found[6] >= 0) & (found[6] <= LONGEST)
        points[felt], normals[felt] = (
            np.where(there, part, np.nan).T for part in (found[:3], found[3:6])
        )
        arc_length[felt] = np.where(there, found[6], np.nan)
        sizes = np.linalg.norm(moment[felt], axis=1)
        torsion[felt] = moment[felt] @ tangent / sizes
        along_force[felt] = -(moment[felt] * found[3:6].T).sum(axis=1) / sizes
        spread, sine_spread = _spread(
            foot[felt], force[felt], moment[felt], tangent, radius, deviation, seed
        )
        uncertainty[felt] = spread
        tip = found[7] > np.maximum(_EXACT, _EXPLAINED * sine_spread)
        phase[felt] = np.where(there, np.where(tip, "tip", "tangent"), "free")
    columns: dict[str, Floats] = dict(zip(FOOT, (foot * beam.length).T, strict=True))
    columns |= dict(zip(CONTACT_POINT, (points * beam.length).T, strict=True))
    columns |= dict(zip(NORMAL, normals.T, strict=True))
    return pd.DataFrame(
        {
            **columns,
            "contact_arc_length": arc_length * beam.length,
            "phase": phase,
            "uncertainty": uncertainty * beam.length,
            "torsion": torsion,
            "along_force": along_force,
        }
    )


def wrench_complaint(found: pd.DataFrame) -> str | None:
    """What the moments of a sweep say that no frictionless straight vibrissa could.

    Parameters
    ----------
    found : pandas.DataFrame
        From `reconstruct_space`.

    Returns
    -------
    str or None
        One line that names what may be wrong; None if nothing is.
    """
    torsion, along = (
        float(np.nanmedian(np.abs(found[name]))) if found[name].notna().any() else 0.0
        for name in ("torsion", "along_force")
    )
    if max(torsion, along) <= _SUSPICIOUS:
        return None
    if along <= _SUSPICIOUS:
        return (
            f"the moment has {torsion:.1%} along the clamp's tangent: the force does not lie in a "
            "plane with it, as with friction across the vibrissa, a curved one or a wrong tangent"
        )
    if torsion <= _SUSPICIOUS:
        return (
            f"the moment has {along:.1%} along the force: the components' frame is turned, one has "
            "the wrong sign, or the moment is not about the foot"
        )
    return (
        f"the moment has {torsion:.1%} along the clamp's tangent and {along:.1%} along the force: "
        "the components are in another frame than the world's, or the contact twists the vibrissa"
    )


def _contacts(
    foot: Floats, force: Floats, moment: Floats, tangent: Floats, radius: float
) -> Floats:
    """Point, normal, arc length and sin(phi1 - alpha), shape (8, n), dimensionless."""
    size = np.linalg.norm(force, axis=1)
    normal = -force / size[:, None]
    down = -(normal @ tangent)
    sideways = normal + down[:, None] * tangent
    sine = np.linalg.norm(sideways, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):  # a force along the clamp's tangent
        lateral = sideways / sine[:, None]
        bending = (moment * np.cross(lateral, tangent)).sum(axis=1)
        planar = np.stack([np.zeros_like(size), -size * sine, size * down, bending])
        found = contact_bent_right(planar)
        criterion = down - bending**2 / (2 * size)
    axis = foot + found.xi[:, None] * lateral + found.eta[:, None] * tangent
    return np.concatenate(
        [(axis - radius * normal).T, normal.T, found.arc_length[None], criterion[None]]
    )


def _spread(
    foot: Floats,
    force: Floats,
    moment: Floats,
    tangent: Floats,
    radius: float,
    deviation: Floats,
    seed: int,
) -> tuple[Floats, Floats]:
    """Where 95 % of the contacts lie that noise makes of each, and the criterion's deviation."""
    if not deviation.any():
        return np.zeros(len(foot)), np.zeros(len(foot))
    random = np.random.default_rng(seed)
    true = _contacts(foot, force, moment, tangent, radius)
    far, sines = [], []
    for _ in range(_SAMPLES):
        disturbed = random.normal(size=(len(foot), 6)) * deviation
        found = _contacts(
            foot, force + disturbed[:, :3], moment + disturbed[:, 3:], tangent, radius
        )
        far.append(np.linalg.norm(found[:3] - true[:3], axis=0))
        sines.append(found[7])
    return (
        np.quantile(np.nan_to_num(far, nan=np.inf), _COVERAGE, axis=0, method="higher"),
        np.std(np.array(sines), axis=0),
    )


def _deviations(noise: Mapping[str, float] | None) -> Floats:
    given = {} if noise is None else dict(noise)
    for name, value in given.items():
        if name not in _COMPONENTS:
            raise InputError("noise", repr(name), f"of {', '.join(_COMPONENTS)}", "correct it")
        if not (is_finite_number(value) and value >= 0):
            raise InputError(f"noise[{name}]", value, "0 or more", "it is a standard deviation")
    return np.array([float(given.get(name, 0.0)) for name in _COMPONENTS])
