"""The body from the clamp's six components, in closed form."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from analytic.from_clamp.contact import LONGEST, contact_bent_right
from analytic.problem.arrays import Floats, Integers
from analytic.problem.support import require_plain
from analytic.space.from_clamp.noise import COMPONENTS, component_noise, felt
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)

_SAMPLES = 400  # of the noise, a station
_AT_ONCE = 10_000  # stations whose samples are in memory, 130 MB
_COVERAGE = 0.95
_EXACT = 1e-9  # sine of an angle: what rounding leaves of one that vanishes
_EXPLAINED = 4.0  # standard deviations that noise may explain
_SUSPICIOUS = 0.02  # share of the moment that must not be there, in the median of a sweep


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
        Standard deviations of the six components by name, each in its unit. If not given, they are
        exact but for what is seen of noise (`component_noise`).
    seed : int
        Of the sampled noise.

    Returns
    -------
    pandas.DataFrame
        A row a station: ``contact_*`` [length] on the body's surface, ``normal_*``,
        ``contact_arc_length`` [length], ``phase``; ``uncertainty`` [length], the distance within
        which the true contact lies in 95 % of all cases; ``torsion`` and ``along_force``, the parts
        of the moment along the clamp's tangent and along the force, over its magnitude. Both vanish
        for a straight isotropic vibrissa without friction; ``torsion_noise`` and
        ``along_force_noise`` are their standard deviations. NaN where no force stands out from
        noise or no vibrissa has such readings; ``phase`` is ``"free"`` there.

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
    units = np.repeat([beam.force_unit, beam.moment_unit], 3)
    known = component_noise(readings, noise)
    on = felt(readings, known)
    deviation, stated = (
        np.array([sizes.get(name, 0.0) for name in COMPONENTS]) / units
        for sizes in (known, noise or {})
    )

    radius = beam.radius / beam.length
    points = np.full((len(foot), 3), np.nan)
    normals, arc_length = points.copy(), np.full(len(foot), np.nan)
    uncertainty, torsion, along_force, torsion_noise, along_noise = (
        arc_length.copy() for _ in range(5)
    )
    phase = np.full(len(foot), "free", dtype=object)
    if on.any():
        found = _contacts(foot[on], force[on], moment[on], tangent, radius)
        there = (found[6] >= 0) & (found[6] <= LONGEST)
        points[on], normals[on] = (
            np.where(there, part, np.nan).T for part in (found[:3], found[3:6])
        )
        arc_length[on] = np.where(there, found[6], np.nan)
        sizes = np.linalg.norm(moment[on], axis=1)
        torsion[on] = moment[on] @ tangent / sizes
        along_force[on] = -(moment[on] * found[3:6].T).sum(axis=1) / sizes
        torsion_noise[on] = np.sqrt(tangent**2 @ deviation[3:] ** 2) / sizes
        lever = moment[on] / np.linalg.norm(force[on], axis=1)[:, None]
        along_noise[on] = (
            np.sqrt(lever**2 @ deviation[:3] ** 2 + found[3:6].T ** 2 @ deviation[3:] ** 2) / sizes
        )
        spread, sine_spread = _spread(
            foot[on], force[on], moment[on], tangent, radius, stated, seed
        )
        uncertainty[on] = spread
        tip = found[7] > np.maximum(_EXACT, _EXPLAINED * sine_spread)
        phase[on] = np.where(there, np.where(tip, "tip", "tangent"), "free")
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
            "torsion_noise": torsion_noise,
            "along_force_noise": along_noise,
        }
    )


def wrench_complaint(found: pd.DataFrame) -> str | None:
    """What force and moment of a sweep say that no frictionless straight vibrissa could.

    What noise may explain is no complaint.

    Parameters
    ----------
    found : pandas.DataFrame
        From `reconstruct_space`.

    Returns
    -------
    str or None
        One line that names what may be wrong; None if nothing is.
    """
    nowhere = _nowhere(found)
    if nowhere is not None:
        return nowhere
    torsion, along = (_beyond_noise(found, name) for name in ("torsion", "along_force"))
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


def contacts_moved(
    readings: SpatialReadings, noise: Mapping[str, float], at: Integers, seed: int = 0
) -> Floats:
    """How far noise moves the contacts that are found, sample by sample."""
    beam = readings.beam
    deviation = np.array([noise.get(name, 0.0) for name in COMPONENTS])
    far, _, reach = _samples(
        readings.values(*FOOT)[at] / beam.length,
        readings.values(*FORCE)[at] / beam.force_unit,
        readings.values(*MOMENT)[at] / beam.moment_unit,
        readings.clamp_tangent,
        beam.radius / beam.length,
        deviation / np.repeat([beam.force_unit, beam.moment_unit], 3),
        np.random.default_rng(seed),
    )
    return np.where((reach >= 0) & (reach <= LONGEST), far * beam.length, np.nan)


def _nowhere(found: pd.DataFrame) -> str | None:
    """That most of the forces act nowhere on the vibrissa; None if they do."""
    on = found["torsion"].notna()
    nowhere, every = int((on & found["contact_x"].isna()).sum()), int(on.sum())
    if nowhere <= every / 2:
        return None
    return (
        f"at {nowhere} of {every} stations with a force no point of the vibrissa has such a force "
        "and moment: signs (they are the clamp's action on the vibrissa), axes, frame or units are "
        "others"
    )


def _beyond_noise(found: pd.DataFrame, name: str) -> float:
    """The median size of what must not be there; 0 where noise may explain it."""
    size = found[name].abs()
    with np.errstate(divide="ignore", invalid="ignore"):  # exact readings have no noise
        deviations = (size / found[f"{name}_noise"]).median()
    return float(size.median()) if deviations > _EXPLAINED else 0.0


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
    random, spread, sine_spread = np.random.default_rng(seed), [], []
    for here in np.array_split(np.arange(len(foot)), len(foot) // _AT_ONCE + 1):
        far, sines, _ = _samples(
            foot[here], force[here], moment[here], tangent, radius, deviation, random
        )
        far = np.nan_to_num(far, nan=np.inf)
        spread.append(np.quantile(far, _COVERAGE, axis=0, method="higher"))
        sine_spread.append(np.std(sines, axis=0))
    return np.concatenate(spread), np.concatenate(sine_spread)


def _samples(
    foot: Floats,
    force: Floats,
    moment: Floats,
    tangent: Floats,
    radius: float,
    deviation: Floats,
    random: np.random.Generator,
) -> tuple[Floats, Floats, Floats]:
    """Distances of disturbed contacts, criteria and arc lengths, each (samples, stations)."""
    true = _contacts(foot, force, moment, tangent, radius)
    far, sines, reach = [], [], []
    for _ in range(_SAMPLES):
        disturbed = random.normal(size=(len(foot), 6)) * deviation
        found = _contacts(
            foot, force + disturbed[:, :3], moment + disturbed[:, 3:], tangent, radius
        )
        far.append(np.linalg.norm(found[:3] - true[:3], axis=0))
        sines.append(found[7])
        reach.append(found[6])
    return np.array(far), np.array(sines), np.array(reach)
