"""The object from the clamp readings alone (paper, section 5)."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import pandas as pd

from analytic.checks.integration import integrate_span
from analytic.from_clamp.contact import (
    LONGEST,
    UNLOADED,
    LocatedContact,
    SweptVibrissa,
    contact_bent_right,
    dimensionless,
    reconstruct_turning,
    sides,
)
from analytic.from_clamp.earlier import METHODS, NAMES, LoadedStations
from analytic.from_clamp.mistaken import likely_mistakes
from analytic.from_clamp.noise import AT_ONCE, SAMPLES, checked_noise, covering
from analytic.from_clamp.phases import judge_phases
from analytic.numerics.arrays import Booleans, Floats, Words
from analytic.problem.columns import SENSED, units
from analytic.problem.errors import InputError, unknown
from analytic.problem.readings import Readings, require_readings
from analytic.problem.table import mirrored_table
from analytic.solver.elastica import tangent_span

_LARGE = 0.99  # quantile of the forces that is called the largest
_MANY = 0.2  # of the stations; of good readings with 3 % of noise up to an eighth have no contact
_CLEAR = 0.1  # of the largest force; with less, noise makes of a contact what it likes


@np.errstate(over="ignore", invalid="ignore")  # readings of 1e300 are of no contact
def reconstruct(
    readings: Readings,
    noise: Mapping[str, float] | None = None,
    seed: int = 0,
    method: str = "elastica",
) -> pd.DataFrame:
    """Contact points from foot position, clamp force and clamp moment, in closed form.

    Each station's point follows from its own readings, whichever phase it is in. The phases are
    judged over the whole sweep, by what its noise makes of each phase's condition
    (`analytic.from_clamp.phases.judge_phases`), and so is whether there is a force at all.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used, and ``status`` to leave stations out of the estimate
        of the noise.
    noise : mapping, optional
        Standard deviation of each sensed column's noise, in the column's unit; columns left out are
        exact. ``relative_noise(readings, 0.01)`` is one per cent of each largest magnitude.
    seed : int
        Of the samples of the noise.
    method : str
        ``"elastica"`` is the closed form, ``"decision"`` the paper's way
        (`reconstruct_by_decision`); the names of earlier methods are in
        `analytic.from_clamp.earlier.METHODS`, and what they return is in
        `reconstruct_earlier`.

    Returns
    -------
    pandas.DataFrame
        A row a station: ``contact_x``, ``contact_y``, ``contact_arc_length`` [length], on the
        body's surface; ``phase``; ``contact_angle`` [rad]; ``status``. NaN and ``"free"`` where no
        force acts, or none that differs from noise; NaN and ``"unexplained"`` where the force
        and moment are of no such vibrissa: ``status`` is then ``"no elastica"``, ``"longer than
        the vibrissa"`` where the contact would be beyond 1.1 L, or ``"neither phase"`` where it
        would clearly be neither at the tip nor tangential. Phase and status are ``"gap"``
        where one of the four is NaN. With `noise` also ``uncertainty``: the true contact point lies
        within this distance of the stated one in 95 % of all cases [length]; infinite where the
        noise allows readings that no elastica has.

    Raises
    ------
    InputError
        If `noise` is no such mapping, there is no such method, or a method other than
        ``"elastica"`` is to find the contact of a vibrissa that varies along its length, is curved
        at rest, rubs, or whose clamp turns.
    """
    require_readings(readings)
    if method == "decision":
        return reconstruct_by_decision(readings)
    if method != "elastica":
        readings.require_plain(f"the method {method}")
        return reconstruct_earlier(readings, method, noise)
    if readings.running != "foot_x":
        return reconstruct_turning(readings, noise, partial(reconstruct, seed=seed))
    judged = judge_phases(readings, noise)
    loaded = judged.phase != "free"
    contact = SweptVibrissa.of(readings).contact(np.where(loaded, dimensionless(readings), np.nan))
    found = _table(readings, contact, loaded, judged.phase, judged.neither)
    if noise is not None:
        radius = _uncertainty(readings, checked_noise(noise), loaded, seed)
        found["uncertainty"] = np.where(
            found["phase"] == "unexplained", np.inf, radius * readings.beam.length
        )
    return found


def require_beam(found: pd.DataFrame, readings: Readings) -> None:
    """Ask for the vibrissa, its units or signs, if the readings cannot be of the one there is.

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
        length, neither at the tip nor tangential, or no elastica at all.
    """
    loaded = clearly_loaded(readings)
    wrong = int((found["status"][loaded] != "ok").sum())
    if 2 * wrong <= loaded.sum():
        return
    sizes = f"length {readings.beam.length:g} and rigidity {readings.beam.base_rigidity:g}"
    allowed = (
        f"the one that was measured ({wrong} of {loaded.sum()} contacts cannot be of this one)"
    )
    likely = _likely(likely_mistakes(readings, loaded, True))
    of_readings = f"units and signs of {readings.source}{likely}"
    remedy = f"check its units (--beam FILE, in Python a Beam), and {of_readings}"
    raise InputError("vibrissa", f"of {sizes}", allowed, remedy)


class Doubt(NamedTuple):
    """That readings are of no such vibrissa, and the mistakes that would explain them."""

    of: str
    mistakes: list[str]

    def __str__(self) -> str:
        check = "check the signs, units and zero of the readings, and the vibrissa"
        return f"{self.of} are of no such vibrissa: {check}{_likely(self.mistakes)}"


def doubt(found: pd.DataFrame, readings: Readings, unsure: bool = False) -> Doubt | None:
    """What to check where many readings are of no such vibrissa; its rigidity may be `unsure`."""
    loaded = clearly_loaded(readings)
    status = found["status"][loaded]
    wrong = int((~status.isin(["ok", "gap"])).sum())
    if wrong <= _MANY * len(status):
        return None
    of = f"{wrong} of {len(status)} readings under load"
    return Doubt(of, likely_mistakes(readings, loaded, False, unsure))


def _likely(mistakes: list[str]) -> str:
    return f"; likely {' or '.join(mistakes)}" if mistakes else ""


def scatter_of_contacts(passes: Sequence[Readings], found: Sequence[pd.DataFrame]) -> float | None:
    """Median distance, over the first pass's stations, of contacts from their mean over passes.

    Those of the other passes in its direction are interpolated; None if no foot position is common
    to two.
    """
    at, bends_left = passes[0].values("foot_x"), passes[0].bends_left
    alike = [pair for pair in zip(passes, found, strict=True) if pair[0].bends_left == bends_left]
    places = []
    for one, table in alike:
        foot_x, x, y = one.values("foot_x"), *table[["contact_x", "contact_y"]].to_numpy().T
        there = np.isfinite(x)
        order = np.flatnonzero(there)[np.argsort(foot_x[there])]
        if order.size:
            ends = {"left": np.nan, "right": np.nan}
            places.append([np.interp(at, foot_x[order], v[order], **ends) for v in (x, y)])
    common = np.array(places)
    common = common[:, :, np.isfinite(common).all(axis=(0, 1))] if places else np.empty((0, 2, 0))
    if len(common) < 2 or not common.size:
        return None
    return float(np.median(np.sqrt(np.sum(np.var(common, axis=0, ddof=1), axis=0))))


def clearly_loaded(readings: Readings) -> Booleans:
    """Stations that show a wrong vibrissa whatever the noise."""
    force = np.hypot(*dimensionless(readings)[1:3])
    force = np.where(readings.trusted, force, 0.0)
    large = float(np.quantile(force, _LARGE, method="lower"))
    felt = force > UNLOADED
    drowned = felt & (judge_phases(readings).phase == "free")
    return np.asarray(felt & (force > _CLEAR * large) & ~drowned, dtype=bool)


def reconstruct_earlier(
    readings: Readings, method: str, noise: Mapping[str, float] | None = None
) -> pd.DataFrame:
    """Contact points by one of the methods that were there before the closed form."""
    if method not in METHODS:
        raise unknown("method", method, NAMES)
    chosen = METHODS[method]
    sensed = dimensionless(readings)
    gap = np.isnan(sensed).any(axis=0)
    phase = np.where(gap, "gap", judge_phases(readings, noise).phase)
    loaded = ~gap & (phase != "free")
    side = sides(sensed)
    foot_x, force_x, force_y, moment = (side * sensed)[:, loaded]
    first = _first_contact(readings, sensed, loaded)
    travel = side[0, loaded] * first / readings.beam.length - foot_x
    answer = chosen.estimate(LoadedStations(foot_x, -force_x, force_y, moment, travel))
    reach = np.hypot(answer.x - foot_x, answer.y)
    x, y = answer
    if "force" in chosen.needs:
        normal = np.arctan2(-force_x, force_y)
        radius = readings.beam.radius / readings.beam.length
        x, y = x - radius * np.sin(normal), y + radius * np.cos(normal)
    status = np.where(gap, "gap", "free").astype(object)
    with np.errstate(invalid="ignore"):
        status[loaded] = np.where(
            np.isnan(x), "no answer", np.where(reach > LONGEST, "longer than the vibrissa", "ok")
        )
    places = np.full((2, len(phase)), np.nan)
    places[:, loaded] = side[0, loaded] * x, y
    contact_x, contact_y = np.where(status == "ok", places * readings.beam.length, np.nan)
    status = status.astype(str)
    return pd.DataFrame(
        {"contact_x": contact_x, "contact_y": contact_y, "phase": phase, "status": status}
    )


def _first_contact(readings: Readings, sensed: Floats, loaded: Booleans) -> float:
    """Where the moment of the first two loaded stations goes to zero, behind the last free one."""
    at = np.flatnonzero(loaded)
    foot_x = readings.values(SENSED[0])
    if len(at) < 2:
        return float(foot_x[at[0]]) if len(at) else 0.0
    first, second = at[:2]
    moment = sensed[3]
    share = moment[first] / (moment[second] - moment[first])
    back = float(foot_x[first] - share * (foot_x[second] - foot_x[first]))
    free = float(foot_x[first - 1]) if first else back
    low, high = sorted((float(foot_x[first]), free))
    return min(max(back, low), high)


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
    require_readings(readings).require_plain("the method decision")
    if readings.bends_left:
        return mirrored_table(reconstruct_by_decision(readings.mirrored(), tolerance))
    sensed = dimensionless(readings)
    force = np.hypot(sensed[1], sensed[2])
    loaded = force > UNLOADED
    _, force_x, force_y, moment = np.where(loaded, sensed, np.nan)
    alpha = np.arctan2(-force_x, force_y)
    tangent = np.abs(2 * force_y - moment**2) <= tolerance * 2 * force
    tangential = tangent_span(alpha).q / np.sqrt(np.where(loaded, force, np.nan))
    arc_length = np.where(tangent, tangential, 1.0)
    x, y = np.full_like(alpha, np.nan), np.full_like(alpha, np.nan)
    # Of a small force the tangential contact may be a thousand lengths away: that is none.
    near = loaded & (arc_length <= LONGEST)
    if near.any():
        end = integrate_span(force_x[near], force_y[near], moment[near], arc_length[near])
        x[near], y[near] = end.x, end.y
    contact = LocatedContact(alpha, np.where(loaded, arc_length, np.nan), sensed[0] + x, y)
    phase = np.where(tangent, "tangent", "tip")
    return _table(readings, contact, loaded, phase, np.zeros_like(loaded))


def _table(
    readings: Readings, contact: LocatedContact, loaded: Booleans, phase: Words, neither: Booleans
) -> pd.DataFrame:
    beam = readings.beam
    x, y = SweptVibrissa.of(readings).surface(contact)
    measured = np.isfinite(dimensionless(readings)).all(axis=0)
    too_long = contact.arc_length > LONGEST
    explained = measured & (contact.arc_length >= 0) & ~too_long & ~neither

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
                [~measured, explained, ~loaded, too_long, neither],
                ["gap", "ok", "free", "longer than the vibrissa", "neither phase"],
                "no elastica",
            ),
        }
    )


def _uncertainty(
    readings: Readings, noise: Mapping[str, float], loaded: Booleans, seed: int
) -> Floats:
    """Radius that covers 95 % of the contact points of readings that differ by noise [L]."""
    beam = readings.beam
    spread = np.array([noise.get(name, 0.0) for name in SENSED]) / units(beam, SENSED)
    held = SweptVibrissa.of(readings)
    sensed = dimensionless(readings)[:, loaded]
    # Noise does not turn the paper's vibrissa to its other side.
    sensed = sides(sensed) * sensed if held.plain else sensed
    contact = contact_bent_right if held.plain else held.contact
    generator = np.random.default_rng(seed)

    def covered(some: Floats) -> Floats:
        random = generator.standard_normal((4, some.shape[1], SAMPLES))
        noisy = some[:, :, None] + spread[:, None, None] * random
        moved, here = (held.surface(contact(x)) for x in (noisy, some[:, :, None]))
        return covering(np.hypot(*np.subtract(moved, here)), axis=1)

    radius = np.full(len(loaded), np.nan)
    pieces = np.array_split(sensed, sensed.shape[1] // AT_ONCE + 1, axis=1)
    radius[loaded] = np.concatenate([covered(piece) for piece in pieces])
    return radius
