"""The budget of a disagreement, from readings alone."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analytic import CLAMP_READINGS, Readings
from analytic.problem.arrays import Floats
from analytic.problem.columns import units
from compare.explain.changes import SHARPER
from compare.explain.convergence import convergence
from compare.explain.oscillation import without_oscillation
from compare.explain.parts import (
    SAFETY,
    Parted,
    Shared,
    Term,
    as_uncertain,
    by_reading,
    common_stations,
    extrapolated,
    observed_order,
    parts_of,
    unexplained,
)
from compare.explain.suspects import Suspect, suspects
from compare.explain.variations import shifted_inward, stretched
from compare.measure.disagreement import rms
from compare.sense.noise import scales

PARTS = (
    "discretisation",
    "facets",
    "softness",
    "corner",
    "unrest",
    "sensor",
    "extension",
    "unexplained",
)
REFINED = ("stiff", "two", "four")
"""The sweeps that differ in their segments alone, each with twice those of the one before."""
UNRESOLVED = 1e-5
"""What no budget resolves, of a reading's largest magnitude."""
SMALL = 5e-5
"""What counts as small in any case."""
_LEAST_ORDER = 1.0  # of a naive clamp; two of one at mid-cell
_SEEN = 0.1  # from a whole number, as an order that is seen
# Two combinations of the three sweeps hold errors of one size, each over ten swings and more: for
# 95 % of such pairs their rms differ by less (F(10, 10) = 3.0).
_COVERS = 1.7
_LEFT, _UNSURE = 0.1, 1 / 3
"""What may stay unexplained of a disagreement that counts as explained, and how uncertain it is."""


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
    # Whether it lies within an uncertainty that is not small: then the budget neither closes nor
    # shows that something is missing.
    undecided: bool = False


def budget(
    exact: Readings,
    runs: Mapping[str, Readings],
    variations: Mapping[str, Readings],
    faceted: Readings | None = None,
) -> Budget:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts."""
    kept = common_stations(exact, [*runs.values()])
    # One that is varied may touch again, or stick, where the reference does not.
    for varied in variations.values():
        kept &= np.isfinite([varied.values(name) for name in CLAMP_READINGS]).all(axis=0)
    shared = Shared(exact, kept)
    run = {name: shared.signal(readings) for name, readings in runs.items()}
    signatures = {name: shared.off(varied) for name, varied in variations.items()}
    base, beam = runs["base"], exact.beam
    order = observed_order(
        run["stiff"] - run["two"], run["two"] - run["four"], nominal=2.0, least=_LEAST_ORDER
    )
    contact = exact.values("contact_arc_length")[kept] / beam.length
    tangent = (exact.table["phase"] == "tangent").to_numpy()[kept] & np.isfinite(contact)
    power: Floats = 0.5 ** (order * np.arange(3.0))
    refined, joints = [run[name] for name in REFINED], _joints(runs)
    if joints is not None:
        refined = without_oscillation(refined, joints, contact, tangent, power)
    limit, doubt = _limit(refined, power)
    _, middle, finest = refined
    from_two = finest + (finest - middle) / (2**order - 1)
    # Only an order that is seen makes the limit better than the finest of the three.
    seen = abs(order - round(order)) < _SEEN
    beyond = SAFETY * (rms(limit - from_two) + (0 if seen else rms(finest - limit)))
    hard = "sharp" if "sharp" in run else "smooth"  # but for its contacts, which are harder next
    unrest = run["base"] - run["calm"]
    # As segments are refined, nothing is left of the load's hand-over from bead to bead.
    still = shifted_inward(signatures, _sunk(runs["stiff"], shared), beam.radius / beam.length)
    steps: dict[str, Term] = {
        "discretisation": (
            run["stiff"] - limit,
            np.hypot(beyond, doubt),
        ),
        "facets": (run["calm"] - run["smooth"], rms(unrest)),
        "softness": (run[hard] - run["stiff"] + still, rms(still)),
        "unrest": as_uncertain(unrest),
        # What is out of balance shows in the sensors, too: that is unrest, and counted there.
        "sensor": as_uncertain(_sensor(runs["calm"], shared)),
        "extension": as_uncertain(stretched(signatures, base.values("extension")[kept])),
    }
    if "sharp" in run:  # linear in the edges' radius
        steps["corner"] = extrapolated(run["smooth"], run["sharp"], SHARPER)
    total = shared.off(base)
    rest, unsure = steps["unexplained"] = unexplained(total, steps)
    unresolved, whole = np.hypot(unsure, UNRESOLVED), rms(total)
    within = bool((rms(rest) <= unresolved).all())
    resolved = bool(
        (rms(rest) <= np.hypot(SMALL, _LEFT * whole)).all()
        and (unsure <= np.hypot(SMALL, _UNSURE * whole)).all()
    )
    phase = exact.table["phase"].to_numpy()[kept]
    shifted = shifted_inward(signatures, _sunk(base, shared), beam.radius / beam.length)
    checks = {"softness": shifted}
    if faceted is not None:
        # A vibrissa curved towards the object touches a straight facet twice, with no readings.
        solved = common_stations(exact, [faceted])[kept]
        if solved.any():
            checks["facets"] = shared.off(faceted)[:, solved]
    parts = parts_of(PARTS, steps)
    return Budget(
        parts=parts,
        disagreement=by_reading(total),
        order=order,
        closes=within and resolved,
        blame=max(parts, key=lambda name: float(np.linalg.norm(rms(steps[name][0])))),
        stations=int(kept.sum()),
        by_phase={
            name: {
                reading: {str(p): float(rms(row[phase == p])) for p in np.unique(phase)}
                for reading, row in zip(CLAMP_READINGS, signal, strict=True)
            }
            for name, (signal, _) in steps.items()
        },
        suspects=suspects(rest, signatures, float(np.linalg.norm(unresolved))),
        convergence=convergence(exact, [runs[name] for name in REFINED], kept),
        checks={name: by_reading(check) for name, check in checks.items()},
        undecided=within and not resolved,
    )


def largest_rms(exact: Readings, candidate: Readings) -> float:
    """The largest of the three readings' disagreements, as a budget counts it."""
    kept = common_stations(exact, [candidate])
    return float(rms(Shared(exact, kept).off(candidate)).max())


def _sunk(run: Readings, shared: Shared) -> Floats:
    """How deep the contact gives way [L]."""
    return np.asarray(run.values("penetration")[shared.kept] / run.beam.length)


def _joints(runs: Mapping[str, Readings]) -> list[Floats] | None:
    """Where each refined sweep's joints are, if all of them say so [L]."""
    recorded = [runs[name].provenance.get("joints") for name in REFINED]
    return None if None in recorded else [np.array(joints, dtype=float) for joints in recorded]


def _limit(refined: list[Floats], power: Floats) -> tuple[Floats, Floats]:
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


def _sensor(run: Readings, shared: Shared) -> Floats:
    """The sensors' discrepancy from the sum of the contacts, the worst of the three readings."""
    sizes = units(run.beam, CLAMP_READINGS) / [*scales(shared.exact).values()]
    return np.asarray(sizes[:, None] * run.values("discrepancy")[shared.kept])
