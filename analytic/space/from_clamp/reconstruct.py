"""The body from the clamp's six components, in closed form."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from analytic.from_clamp.contact import LONGEST, UNLOADED, contact_bent_right
from analytic.from_clamp.noise import AT_ONCE, SAMPLES, checked_noise, covering, scatter
from analytic.from_clamp.passes import listed
from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.errors import InputError, require
from analytic.problem.support import require_plain
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)

COMPONENTS = (*FORCE, *MOMENT)
_SIGMAS = 5.0  # noise alike in x, y and z makes more of no force once in 65,000 stations
_BOTH = np.sqrt(2.0)  # where nothing touches, noise of force and of moment make one product

_AS_READ = "as read_space gives them"
_EXACT = 1e-9  # sine of an angle: what rounding leaves of one that vanishes
_EXPLAINED = 4.0  # standard deviations that noise may explain
_TURNED = 0.02  # rad; on a flat face noise alone turns a normal
# Cosine between the ways of contact and normal, in the mean: 0.5 to 1 with up to 3 % of noise on
# spheres and eggs, -1 to -0.3 with the opposite signs.
_HOLLOW = 0.3
_SUSPICIOUS = 0.02  # share of the moment that must not be there, in the median of a sweep


def component_noise(
    readings: SpatialReadings, stated: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Standard deviation of each component's noise: what is stated, or seen if that is more.

    What jumps from station to station is seen, as in the plane. Stations that lie far apart seem to
    jump, too; but one force, wherever it acts and in whatever frame, has no moment along itself:
    what F . M jumps by is noise and nothing else, and if it is less than what was seen allows, what
    was seen is so much less noise.
    """
    given = {} if stated is None else checked_noise(stated, COMPONENTS)
    force, moment = readings.values(*FORCE), readings.values(*MOMENT)
    loaded = readings.trusted & force.any(axis=1)
    force, moment = force[loaded], moment[loaded]
    seen = np.array([scatter(values) for values in np.hstack([force, moment]).T])
    allowed = np.sqrt(moment**2 @ seen[:3] ** 2 + force**2 @ seen[3:] ** 2)
    product = (force * moment).sum(axis=1)
    share = min(1.0, _BOTH * scatter(product[allowed > 0] / allowed[allowed > 0]))
    return {
        name: max(float(given.get(name, 0.0)), share * float(size))
        for name, size in zip(COMPONENTS, seen, strict=True)
    }


def over_units(noise: Mapping[str, float], beam: Beam) -> Floats:
    """Those of the six components, dimensionless; nothing of what is not there."""
    units = np.repeat([beam.force_unit, beam.moment_unit], 3)
    return np.asarray([noise.get(name, 0.0) for name in COMPONENTS] / units)


def least_force(readings: SpatialReadings, noise: Mapping[str, float]) -> float:
    """The force below which a station is taken for free."""
    return max(_SIGMAS * max(noise[name] for name in FORCE), UNLOADED * readings.beam.force_unit)


def felt(readings: SpatialReadings, noise: Mapping[str, float]) -> Booleans:
    """Trusted stations with a force that noise does not make."""
    force = np.linalg.norm(readings.values(*FORCE), axis=1)
    return np.asarray(readings.trusted & (force > least_force(readings, noise)))


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
    require("readings", readings, SpatialReadings, _AS_READ)
    beam, tangent = readings.beam, readings.clamp_tangent
    require_plain("the reconstruction in space", beam)
    clamp = ClampInSpace.of(readings)
    known = component_noise(readings, noise)
    on = np.flatnonzero(felt(readings, known))
    deviation, stated = (over_units(sizes, beam) for sizes in (known, noise or {}))
    loaded = clamp.at(on)
    place, normal, arc_length, criterion = np.split(loaded.contacts(), [3, 6, 7])
    there = (arc_length[0] >= 0) & (arc_length[0] <= LONGEST)
    moment, size = loaded.moment, np.linalg.norm(loaded.moment, axis=1)
    size[size == 0] = np.inf  # no part of no moment is along anything
    lever = moment / np.linalg.norm(loaded.force, axis=1)[:, None]
    along_noise = lever**2 @ deviation[:3] ** 2 + normal.T**2 @ deviation[3:] ** 2
    uncertainty, sine_spread = _spread(loaded, stated, seed)
    tip = criterion[0] > np.maximum(_EXACT, _EXPLAINED * sine_spread)
    columns = {
        **dict(zip(CONTACT_POINT, np.where(there, place * beam.length, np.nan), strict=True)),
        **dict(zip(NORMAL, np.where(there, normal, np.nan), strict=True)),
        "contact_arc_length": np.where(there, arc_length[0] * beam.length, np.nan),
        "phase": np.where(there, np.where(tip, "tip", "tangent"), "free"),
        "uncertainty": uncertainty * beam.length,
        "torsion": moment @ tangent / size,
        "along_force": -(moment * normal.T).sum(axis=1) / size,
        "torsion_noise": np.sqrt(tangent**2 @ deviation[3:] ** 2) / size,
        "along_force_noise": np.sqrt(along_noise) / size,
    }
    feet = pd.DataFrame(dict(zip(FOOT, (clamp.foot * beam.length).T, strict=True)))
    return feet.join(pd.DataFrame(columns, index=on)).fillna({"phase": "free"})


def of_one_vibrissa(
    readings: SpatialReadings | Sequence[SpatialReadings],
) -> Sequence[SpatialReadings]:
    """One sweep or several past a body, for who needs a straight and uniform vibrissa."""
    sweeps = listed(readings)
    for one in sweeps:
        require("readings", one, SpatialReadings, _AS_READ)
        require_plain("the fit of a body", one.beam)
        if one.beam != sweeps[0].beam:
            what = "of different vibrissae"
            raise InputError("readings", what, "of one", "fit each on its own")
    return sweeps


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
    impossible = _nowhere(found) or _hollow(found)
    if impossible is not None:
        return impossible
    torsion, along = (_beyond_noise(found, name) for name in ("torsion", "along_force"))
    if max(torsion, along) <= _SUSPICIOUS:
        return None
    if along <= _SUSPICIOUS:
        return (
            f"the moment has {torsion:.1%} along the clamp's tangent: the force does not lie in a "
            "plane with it, as with components in the clamp's frame (of a file: `--frame clamp`), "
            "a wrong tangent, friction across the vibrissa, or a curved one"
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
    clamp, deviation = ClampInSpace.of(readings).at(at), over_units(noise, readings.beam)
    far, _, reach = clamp.samples(deviation, np.random.default_rng(seed))
    return np.where((reach >= 0) & (reach <= LONGEST), far * readings.beam.length, np.nan)


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


def _hollow(found: pd.DataFrame) -> str | None:
    """That the contacts lie on a hollow surface; None if they do not.

    On a convex body the normal turns the way in which the contact moves.
    """
    there = found[found["contact_x"].notna()]
    apart = max(len(there) // 3, 1)
    moved, turned = (
        there[[*names]].to_numpy()[apart:] - there[[*names]].to_numpy()[:-apart]
        for names in (CONTACT_POINT, NORMAL)
    )
    size = np.linalg.norm(moved, axis=1) * np.linalg.norm(turned, axis=1)
    size[np.linalg.norm(turned, axis=1) < _TURNED] = 0.0
    along = (moved * turned).sum(axis=1)[size > 0].sum()
    if along >= -_HOLLOW * size.sum():
        return None
    return (
        "the contacts lie on a hollow surface, no convex body's: signs (they are the clamp's "
        "action on the vibrissa), axes, frame or the rows' order are others"
    )


def _beyond_noise(found: pd.DataFrame, name: str) -> float:
    """The median size of what must not be there; 0 where noise may explain it."""
    size = found[name].abs()
    with np.errstate(divide="ignore", invalid="ignore"):  # exact readings have no noise
        deviations = (size / found[f"{name}_noise"]).median()
    return float(size.median()) if deviations > _EXPLAINED else 0.0


class ClampInSpace(NamedTuple):
    """What the clamp is and feels at n stations, dimensionless."""

    foot: Floats
    force: Floats
    moment: Floats
    tangent: Floats
    radius: float

    @classmethod
    def of(cls, readings: SpatialReadings) -> "ClampInSpace":
        beam = readings.beam
        return cls(
            readings.values(*FOOT) / beam.length,
            readings.values(*FORCE) / beam.force_unit,
            readings.values(*MOMENT) / beam.moment_unit,
            readings.clamp_tangent,
            beam.radius / beam.length,
        )

    def at(self, which: Booleans | Integers) -> "ClampInSpace":
        foot, force, moment = (values[which] for values in self[:3])
        return self._replace(foot=foot, force=force, moment=moment)

    @property
    def components(self) -> Floats:
        """Force and moment, shape (n, 6)."""
        return np.hstack([self.force, self.moment])

    def feeling(self, components: Floats) -> "ClampInSpace":
        return self._replace(force=components[:, :3], moment=components[:, 3:])

    def contacts(self) -> Floats:
        """Point, normal, arc length and sin(phi1 - alpha), shape (8, n)."""
        size = np.linalg.norm(self.force, axis=1)
        normal = -self.force / size[:, None]
        down = -(normal @ self.tangent)
        sideways = normal + down[:, None] * self.tangent
        sine = np.linalg.norm(sideways, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):  # a force along the clamp's tangent
            lateral = sideways / sine[:, None]
            bending = (self.moment * np.cross(lateral, self.tangent)).sum(axis=1)
            planar = np.stack([np.zeros_like(size), -size * sine, size * down, bending])
            found = contact_bent_right(planar)
            criterion = down - bending**2 / (2 * size)
        axis = self.foot + found.xi[:, None] * lateral + found.eta[:, None] * self.tangent
        place = (axis - self.radius * normal).T
        return np.concatenate([place, normal.T, found.arc_length[None], criterion[None]])

    def samples(
        self, deviation: Floats, random: np.random.Generator
    ) -> tuple[Floats, Floats, Floats]:
        """Distances of disturbed contacts, criteria and arc lengths, each (samples, stations)."""
        true, every = self.contacts(), []
        for _ in range(SAMPLES):
            disturbed = random.normal(size=(len(self.foot), 6)) * deviation
            found = self.feeling(self.components + disturbed).contacts()
            every.append((np.linalg.norm(found[:3] - true[:3], axis=0), found[7], found[6]))
        far, sines, reach = np.array(every).swapaxes(0, 1)
        return far, sines, reach


def _spread(clamp: ClampInSpace, deviation: Floats, seed: int) -> tuple[Floats, Floats]:
    """Where 95 % of the contacts lie that noise makes of each, and the criterion's deviation."""
    count = len(clamp.foot)
    if not deviation.any():
        return np.zeros(count), np.zeros(count)
    random, spread = np.random.default_rng(seed), []
    for here in np.array_split(np.arange(count), count // AT_ONCE + 1):
        far, sines, _ = clamp.at(here).samples(deviation, random)
        spread.append((covering(far, axis=0), np.std(sines, axis=0)))
    uncertainty, sine_spread = np.concatenate(spread, axis=1)
    return uncertainty, sine_spread
