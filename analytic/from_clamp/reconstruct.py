"""The object from the clamp readings alone (paper, section 5)."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import pandas as pd

from analytic.checks.integration import integrate_span
from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.problem.columns import CLAMP_READINGS, SENSED
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from analytic.problem.table import mirrored_table
from analytic.solver.elastica import frame, span, span_of_moment

_UNLOADED = 1e-9  # of EI/L^2: below, a force has no direction to speak of
_SIGMAS = 5.0  # the same, in standard deviations of the force's noise
_SAMPLES = 400  # of the noise, a station
_COVERAGE = 0.95
_CLEAR = 0.1  # of the largest force; with less, noise makes of a contact what it likes
_LONGEST = 1.1  # L; a tip contact seen through a few percent of noise may seem as long
_NEARLY_ONE = 1e-6  # L; by how much a contact may miss the tip and still be called a tip contact


class Contact(NamedTuple):
    """Contact points of the centreline, dimensionless; arrays of one shape."""

    alpha: Floats
    arc_length: Floats
    xi: Floats
    eta: Floats


def reconstruct(
    readings: Readings, noise: Mapping[str, float] | None = None, seed: int = 0
) -> pd.DataFrame:
    """Contact points from foot position, clamp force and clamp moment, in closed form.

    The force's direction is the contour's normal, so tan(alpha) = -F_x/F_y; force and moment fix
    the modulus, k^2 = (1 + (M^2 - 2 F_y)/(2 f))/2, and with it the whole elastica up to where its
    curvature vanishes, which is the contact. No decision between the phases is needed for that:
    the phase follows from the contact's arc length.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.
    noise : mapping, optional
        Standard deviation of each sensed column's noise, in its unit; columns left out are exact.
    seed : int
        Of the samples of the noise.

    Returns
    -------
    pandas.DataFrame
        A row a station: ``contact_x``, ``contact_y``, ``contact_arc_length`` [length], on the
        body's surface; ``phase``; ``contact_angle`` [rad]; ``status``. NaN and ``"free"`` where no
        force acts, NaN and ``"unexplained"`` where the force and moment are of no such vibrissa:
        ``status`` is then ``"no elastica"``, or ``"longer than the vibrissa"`` where the contact
        would be beyond 1.1 L. Phase and status are ``"gap"`` where one of the four is NaN. With
        `noise` also
        ``uncertainty``: the true contact point lies within this distance of the stated one in 95 %
        of all cases [length]; infinite where the noise allows readings that no elastica has.
    """
    found = _bent_right(readings, noise, seed)
    left = readings.values("moment_z") < 0
    if left.any():  # all stations of a sweep to the right, or those after a swing to the other side
        mirrored = mirrored_table(_bent_right(readings.mirrored(), noise, seed))
        found.loc[left] = mirrored.loc[left]
    return found


def _bent_right(readings: Readings, noise: Mapping[str, float] | None, seed: int) -> pd.DataFrame:
    """`reconstruct`, where the clamp's moment is positive."""
    beam = readings.beam
    sensed = _dimensionless(readings)
    loaded = np.hypot(sensed[1], sensed[2]) > _threshold(readings, noise)
    contact = _contact(np.where(loaded, sensed, np.nan))
    phase = np.where(contact.arc_length < 1 - _NEARLY_ONE, "tangent", "tip")
    found = _table(readings, contact, loaded, phase)
    if noise is not None:
        radius = _uncertainty(readings, noise, loaded, contact, seed) * beam.length
        found["uncertainty"] = np.where(found["phase"] == "unexplained", np.inf, radius)
    return found


def require_beam(found: pd.DataFrame, readings: Readings) -> None:
    """Ask for the vibrissa, or for its units, if the readings cannot be of the one there is.

    Parameters
    ----------
    found : pandas.DataFrame
        What `reconstruct` made of the readings.
    readings : Readings
        With the default beam if nobody named another.

    Raises
    ------
    InputError
        If most stations with a good part of the largest force have contacts beyond the vibrissa's
        length, or no elastica at all.
    """
    loaded = clearly_loaded(readings)
    wrong = int((found["status"][loaded] != "ok").sum())
    if 2 * wrong <= loaded.sum():
        return
    impossible = f"{wrong} of {loaded.sum()} contacts cannot be of"
    if readings.beam == Beam():
        raise InputError(
            "vibrissa",
            "none given",
            f"the one that was measured ({impossible} L = EI = 1)",
            "use --beam FILE (in Python a Beam), in the units of the readings",
        )
    raise InputError(
        "vibrissa",
        f"of length {readings.beam.length:g} and flexural rigidity "
        f"{readings.beam.flexural_rigidity:g}",
        f"the one that was measured ({impossible} this one)",
        f"check its units, and those of {readings.source}",
    )


def clearly_loaded(readings: Readings) -> Booleans:
    """Stations that show a wrong vibrissa whatever the noise.

    Parameters
    ----------
    readings : Readings
        One sweep.

    Returns
    -------
    array of bool, shape (stations,)
        Whether the force is more than a tenth of the largest.
    """
    force = np.hypot(readings.values("force_x"), readings.values("force_y"))
    return np.asarray(force > _CLEAR * np.nanmax(force, initial=0.0), dtype=bool)


def reconstruct_by_decision(readings: Readings, tolerance: float = 1e-6) -> pd.DataFrame:
    """The paper's own way: decide the phase by (26), then integrate up to the contact.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.
    tolerance : float
        How far (2 F_y - M^2)/(2 f) may be from zero to be called so.

    Returns
    -------
    pandas.DataFrame
        As `reconstruct`.
    """
    if readings.bends_left:
        return mirrored_table(reconstruct_by_decision(readings.mirrored(), tolerance))
    sensed = _dimensionless(readings)
    force = np.hypot(sensed[1], sensed[2])
    loaded = force > _UNLOADED
    _, force_x, force_y, moment = np.where(loaded, sensed, np.nan)
    alpha = np.arctan2(-force_x, force_y)
    tangent = np.abs(2 * force_y - moment**2) <= tolerance * 2 * force
    tangential = span(np.pi / 2 - np.abs(alpha), alpha).q / np.sqrt(np.where(loaded, force, np.nan))
    arc_length = np.where(tangent, tangential, 1.0)
    x, y = np.full_like(alpha, np.nan), np.full_like(alpha, np.nan)
    if loaded.any():
        end = integrate_span(force_x[loaded], force_y[loaded], moment[loaded], arc_length[loaded])
        x[loaded], y[loaded] = end.x, end.y
    contact = Contact(alpha, np.where(loaded, arc_length, np.nan), sensed[0] + x, y)
    return _table(readings, contact, loaded, np.where(tangent, "tangent", "tip"))


def _dimensionless(readings: Readings) -> Floats:
    """The sensed columns, shape (4, stations)."""
    beam = readings.beam
    units = (beam.length, beam.force_unit, beam.force_unit, beam.moment_unit)
    return np.array([readings.values(n) / u for n, u in zip(SENSED, units, strict=True)])


def _threshold(readings: Readings, noise: Mapping[str, float] | None) -> float:
    """The force below which there is none, dimensionless."""
    if noise is None:
        return _UNLOADED
    of_force = np.hypot(noise.get("force_x", 0.0), noise.get("force_y", 0.0))
    return max(_UNLOADED, _SIGMAS * float(of_force) / readings.beam.force_unit)


def _contact(sensed: Floats) -> Contact:
    """Slope angle, arc length and position of the centreline's contact; any shape (4, ...)."""
    foot_x, force_x, force_y, moment = sensed
    root_f = np.sqrt(np.hypot(force_x, force_y))
    alpha = np.arctan2(-force_x, force_y)
    loaded = span_of_moment(moment / root_f, alpha)
    up, across = frame(loaded, alpha)
    return Contact(alpha, loaded.q / root_f, foot_x + across / root_f, up / root_f)


def _surface(contact: Contact, radius: float) -> tuple[Floats, Floats]:
    """The contact on the body's surface."""
    return (
        contact.xi - radius * np.sin(contact.alpha),
        contact.eta + radius * np.cos(contact.alpha),
    )


def _table(readings: Readings, contact: Contact, loaded: Booleans, phase: Floats) -> pd.DataFrame:
    beam = readings.beam
    x, y = _surface(contact, beam.radius / beam.length)
    measured = np.isfinite(_dimensionless(readings)).all(axis=0)
    too_long = contact.arc_length > _LONGEST
    explained = measured & (contact.arc_length >= 0) & ~too_long

    def where_explained(values: Floats, unit: float) -> Floats:
        return np.where(explained, values * unit, np.nan)

    return pd.DataFrame(
        {
            "contact_x": where_explained(x, beam.length),
            "contact_y": where_explained(y, beam.length),
            "contact_arc_length": where_explained(contact.arc_length, beam.length),
            "phase": np.select(
                [~measured, explained, loaded], ["gap", phase, "unexplained"], "free"
            ),
            "contact_angle": contact.alpha,
            "status": np.select(
                [~measured, explained, ~loaded, too_long],
                ["gap", "ok", "free", "longer than the vibrissa"],
                "no elastica",
            ),
        }
    )


def _uncertainty(
    readings: Readings,
    noise: Mapping[str, float],
    loaded: Booleans,
    contact: Contact,
    seed: int,
) -> Floats:
    """Radius that covers 95 % of the contact points of readings that differ by noise [L]."""
    beam = readings.beam
    units = (beam.length, beam.force_unit, beam.force_unit, beam.moment_unit)
    spread = np.array([noise.get(n, 0.0) / u for n, u in zip(SENSED, units, strict=True)])
    sensed = _dimensionless(readings)[:, loaded]
    random = np.random.default_rng(seed).standard_normal((4, sensed.shape[1], _SAMPLES))
    moved = _surface(
        _contact(sensed[:, :, None] + spread[:, None, None] * random), beam.radius / beam.length
    )
    here = _surface(contact, beam.radius / beam.length)
    miss = np.hypot(*(m - h[loaded][:, None] for m, h in zip(moved, here, strict=True)))
    radius = np.full(len(loaded), np.nan)
    radius[loaded] = np.quantile(
        np.nan_to_num(miss, nan=np.inf), _COVERAGE, axis=1, method="higher"
    )
    return radius


def relative_noise(readings: Readings, level: float) -> dict[str, float]:
    """Noise in proportion to each clamp reading's largest magnitude, as `reconstruct` takes it.

    Parameters
    ----------
    readings : Readings
        Whose magnitudes count.
    level : float
        Standard deviation over largest magnitude.

    Returns
    -------
    dict
        Standard deviation by column, in the column's unit.
    """
    return {
        name: level * float(np.nanmax(np.abs(readings.values(name)))) for name in CLAMP_READINGS
    }
