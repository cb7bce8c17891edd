"""The budget of a disagreement at rest: which sweeps it needs, and what it makes of them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.numerics.arrays import Floats
from analytic.problem.columns import units
from analytic.space import SpatialReadings
from compare.explain.fit import Suspect, suspects
from compare.explain.oscillation import without_oscillation
from compare.explain.parts import (
    SAFETY,
    UNRESOLVED,
    Account,
    Parted,
    Shared,
    common_stations,
    convergence,
    observed_order,
)
from compare.explain.variations import STEP, shifted_inward
from compare.measure.disagreement import rms
from compare.sense.noise import scales
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.settings import Settings, SpatialSettings

STIFFER = 10  # times the contact stiffness
SHARPER = 10  # times less of the corners' radius
CALMER = 100  # times less out of balance
_REFINED = "it is refined from there"
_AT_REST = 1e-8  # EI/L; what all the other sweeps are out of balance by at most


def controlled_changes(
    settings: Settings, smooth: bool = True, corners: bool = False
) -> dict[str, Settings]:
    """The settings of all sweeps by name; ``base`` is the one that the budget is of.

    They lead from the base to the exact problem, one thing after the other: ``calm`` is more at
    rest, ``smooth`` has no facets, ``sharp`` has sharper corners, ``stiff`` has harder contacts,
    and ``two`` and ``four`` have more segments too. Facets come first, for without them the beam's
    order is plain to see, and segments last, since they bring more beads, which share the load and
    so harden a loose contact.
    """
    n, k = settings.segments, settings.contact_stiffness
    for name, value, most in (("segments", n, 250), ("contact_stiffness", k, 1e8)):
        if value > most:
            raise InputError(f"mujoco.{name} of a budget", value, f"at most {most:g}", _REFINED)
    if corners and (radius := settings.corner_radius) < 1e-8:
        raise InputError("mujoco.corner_radius of a budget", radius, "at least 1e-08", _REFINED)
    rest = replace(settings, tolerance=min(settings.tolerance, _AT_REST))
    plain = replace(rest, obstacle="primitive") if smooth else rest
    sharp = replace(plain, corner_radius=settings.corner_radius / SHARPER) if corners else plain
    stiff = replace(sharp, contact_stiffness=STIFFER * k)
    return {
        "base": settings,
        "calm": replace(settings, tolerance=min(settings.tolerance / CALMER, _AT_REST)),
        "smooth": plain,
        **({"sharp": sharp} if corners else {}),
        "stiff": stiff,
        "two": replace(stiff, segments=2 * n),
        "four": replace(stiff, segments=4 * n),
    }


REFINED = ("stiff", "two", "four")
"""The sweeps that differ in their segments alone, each with twice those of the one before."""
_LEAST_ORDER = 1.0  # of a naive clamp; two of one at mid-cell
_SEEN = 0.1  # from a whole number, as an order that is seen
# Two combinations of the three sweeps hold errors of one size, each over ten swings and more: for
# 95 % of such pairs their rms differ by less (F(10, 10) = 3.0).
_COVERS = 1.7


@dataclass(frozen=True, repr=False)
class Budget(Parted):
    """What the disagreement of two sweeps is made of; ``corner`` only if there are sharp ones.

    It closes if what is unexplained lies within its uncertainty and `UNRESOLVED`, and both it and
    its uncertainty are small against the disagreement, or less than `SMALL`.
    """

    by_phase: dict[str, dict[str, dict[str, float]]]  # root mean square by part, reading and phase
    # Faults of the physics that would explain what the numerics do not, likeliest first.
    suspects: tuple[Suspect, ...]
    # Root mean square of the disagreement, without facets, by number of segments and reading.
    convergence: dict[int, dict[str, float]]
    # What the closed form says of two parts, with no simulator in it, as root mean square by
    # reading: ``facets``, of a contact that is hard, and ``softness``.
    checks: dict[str, dict[str, float]]


def budget(
    exact: Readings,
    runs: Mapping[str, Readings],
    variations: Mapping[str, Readings],
    faceted: Readings | None = None,
) -> Budget:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts."""
    kept = common_stations(exact, runs.values())
    # One that is varied may touch again, or stick, where the reference does not.
    for varied in variations.values():
        kept &= np.isfinite([varied.values(name) for name in CLAMP_READINGS]).all(axis=0)
    account = Account(shared := Shared(exact, kept), runs)
    run, base, thickness = account.run, runs["base"], exact.beam.radius / exact.beam.length
    signatures = {name: shared.off(varied) for name, varied in variations.items()}
    order = observed_order(
        run["stiff"] - run["two"], run["two"] - run["four"], nominal=2.0, least=_LEAST_ORDER
    )
    limit, beyond = _limit(account, runs, exact, order)
    account.add("discretisation", run["stiff"] - limit, beyond)
    unrest = run["base"] - run["calm"]
    account.add("facets", run["calm"] - run["smooth"], rms(unrest))
    hard = "sharp" if "sharp" in run else "smooth"  # but for its contacts, which are harder next
    # As segments are refined, nothing is left of the load's hand-over from bead to bead.
    still = shifted_inward(signatures, _sunk(runs["stiff"], shared), thickness)
    account.add("softness", run[hard] - run["stiff"] + still, rms(still))
    if "sharp" in run:  # linear in the edges' radius
        account.add_extrapolated("corner", run["smooth"], run["sharp"], SHARPER)
    account.add_uncertain("unrest", unrest)
    # What is out of balance shows in the sensors, too: that is unrest, and counted there.
    # Their discrepancy from the sum of the contacts is the worst of the three readings.
    sizes = units(base.beam, CLAMP_READINGS) / [*scales(exact).values()]
    account.add_uncertain("sensor", sizes[:, None] * runs["calm"].values("discrepancy")[kept])
    longer = signatures["length"] * base.values("extension")[kept] / STEP
    account.add_uncertain("extension", longer)
    _, unsure = account.settle()
    phase = exact.table["phase"].to_numpy()[kept]
    checks = {"softness": shifted_inward(signatures, _sunk(base, shared), thickness)}
    if faceted is not None:
        # A vibrissa curved towards the object touches a straight facet twice, with no readings.
        solved = common_stations(exact, [faceted])[kept]
        if solved.any():
            checks["facets"] = shared.off(faceted)[:, solved]
    rest, _ = account.terms["unexplained"]
    return Budget(
        **account.common(),
        order=order,
        **account.closing(),
        blame=account.blame(),
        by_phase={
            name: {
                reading: {str(p): float(rms(row[phase == p])) for p in np.unique(phase)}
                for reading, row in zip(CLAMP_READINGS, signal, strict=True)
            }
            for name, (signal, _) in account.terms.items()
        },
        suspects=suspects(rest, signatures, float(np.linalg.norm(np.hypot(unsure, UNRESOLVED)))),
        convergence=convergence(shared, [runs[name] for name in REFINED]),
        checks={name: shared.rms(check) for name, check in checks.items()},
    )


def largest_rms(exact: Readings, candidate: Readings) -> float:
    """The largest of the three readings' disagreements, as a budget counts it."""
    return float(rms(Shared.of(exact, candidate).off(candidate)).max())


def _sunk(run: Readings, shared: Shared) -> Floats:
    """How deep the contact gives way [L]."""
    return np.asarray(run.values("penetration")[shared.kept] / run.beam.length)


def _limit(
    account: Account, runs: Mapping[str, Readings], exact: Readings, order: float
) -> tuple[Floats, Floats]:
    """What the sweeps tend to as segments are refined, and how uncertain that is."""
    refined: list[Floats] = [account.run[name] for name in REFINED]
    power: Floats = 0.5 ** (order * np.arange(3.0))
    joints = [runs[name].provenance.get("joints") for name in REFINED]
    if None not in joints:
        kept = account.shared.kept
        contact = exact.values("contact_arc_length")[kept] / exact.beam.length
        tangent = (exact.table["phase"] == "tangent").to_numpy()[kept] & np.isfinite(contact)
        at = [np.array(each, dtype=float) for each in joints]
        refined = without_oscillation(refined, at, contact, tangent, power)
    limit, doubt = _fitted_limit(refined, power)
    _, middle, finest = refined
    from_two = finest + (finest - middle) / (2**order - 1)
    # Only an order that is seen makes the limit better than the finest of the three.
    seen = abs(order - round(order)) < _SEEN
    beyond = SAFETY * (rms(limit - from_two) + (0 if seen else rms(finest - limit)))
    return limit, np.hypot(beyond, doubt)


def _fitted_limit(refined: list[Floats], power: Floats) -> tuple[Floats, Floats]:
    """What the sweeps tend to as segments are refined, and how unsure the three of them leave that.

    Richardson's extrapolation, from all three. What still oscillates in them, as the contact passes
    from bead to bead, falls no faster than their power of h. So a line in that power is fitted,
    each sweep weighed by it: the limit has three quarters of the amplitude that the two finest
    sweeps alone leave it. One combination of three sweeps holds neither the limit nor the power.
    What is left in it are their own errors, which the limit has its part of.
    """
    design = np.column_stack([np.ones(3), power]) / power[:, None]
    weights = np.linalg.pinv(design)[0] / power
    apart = np.cross(np.ones(3), power)
    stacked = np.stack(refined)
    errors = rms(np.tensordot(apart, stacked, axes=1)) / np.linalg.norm(apart * power)
    limit = np.tensordot(weights, stacked, axes=1)
    return np.asarray(limit), np.asarray(_COVERS * errors * np.linalg.norm(weights * power))


_ORDER = 2.0  # of the chain in 1/N
_MOST = 400  # segments


def changes_in_space(settings: SpatialSettings) -> dict[str, SpatialSettings]:
    """The settings of all sweeps by name; ``base`` is the one that the budget is of."""
    segments, stiffness = 2 * settings.segments, STIFFER * settings.contact_stiffness
    if segments > _MOST:  # half as many show the same
        segments = settings.segments // 2
    if stiffness > CONTACT_STIFFNESSES[1]:
        stiffness = settings.contact_stiffness / STIFFER
    return {
        "base": settings,
        "segments": replace(settings, segments=segments),
        "stiffness": replace(settings, contact_stiffness=stiffness),
    }


def budget_in_space(
    exact: SpatialReadings,
    runs: Mapping[str, SpatialReadings],
    changes: Mapping[str, SpatialSettings],
) -> Parted:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts.

    Each of the six components is relative to the largest of its kind, force or moment.
    """
    shared = np.logical_and.reduce([one.touching for one in (exact, *runs.values())])
    account = Account(Shared(exact, shared), runs)
    base, run = changes["base"], account.run
    finer = (changes["segments"].segments / base.segments) ** _ORDER
    harder = changes["stiffness"].contact_stiffness / base.contact_stiffness
    account.add_extrapolated("discretisation", run["base"], run["segments"], finer)
    account.add_extrapolated("softness", run["base"], run["stiffness"], harder)
    account.settle()
    return Parted(**account.common(), **account.closing(), order=_ORDER, blame=account.blame())
