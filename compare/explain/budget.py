"""The budget of a disagreement, from readings alone."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS, Readings
from analytic.problem.arrays import Floats
from compare.explain.changes import SHARPER, STIFFER
from compare.explain.convergence import convergence
from compare.explain.oscillation import without_oscillation
from compare.explain.parts import (
    SAFETY,
    Part,
    Shared,
    by_reading,
    common_stations,
    observed_order,
    parts_of,
    root_of_squares,
    with_unexplained,
)
from compare.explain.suspects import Suspect, suspects
from compare.explain.variations import shifted_inward, stretched
from compare.judge.tolerances import Tolerances
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
UNRESOLVED = 5e-5
"""What may stay unexplained in any case, of a reading's largest magnitude."""
_LEAST_ORDER = 1.0  # of a naive clamp; two of one at mid-cell
_LEFT, _UNSURE = 0.1, 1 / 3
"""What may stay unexplained of a disagreement that counts as explained, and how uncertain it is."""


@dataclass(frozen=True)
class Budget:
    """What the disagreement of two sweeps is made of."""

    # `Part` by name and reading; ``corner`` only if MuJoCo's object has sharp ones.
    parts: dict[str, dict[str, Part]]
    # Root mean square by reading, over the stations in contact and trusted in all sweeps: fewer
    # than a comparison's, where some of them failed to settle.
    disagreement: dict[str, float]
    by_phase: dict[str, dict[str, dict[str, float]]]  # root mean square by part, reading and phase
    order: float  # observed order of convergence in the number of segments
    # Whether what is unexplained lies within the uncertainty of the parts, and both are small
    # against the disagreement or against `UNRESOLVED`.
    closes: bool
    blame: str  # the part that dominates
    # Faults of the physics that would explain what the numerics do not, likeliest first.
    suspects: tuple[Suspect, ...]
    stations: int  # compared stations
    # Root mean square of the disagreement, without facets, by number of segments and reading.
    convergence: dict[int, dict[str, float]]
    # What the closed form says of two parts, with no simulator in it, as root mean square by
    # reading: ``facets``, of a contact that is hard, and ``softness``.
    checks: dict[str, dict[str, float]]
    # Whether it lies within an uncertainty that is not small: then the budget neither closes nor
    # shows that something is missing.
    undecided: bool = False

    def to_dict(self) -> dict[str, Any]:
        """What ``budget.json`` holds."""
        return asdict(self)


def budget(
    exact: Readings,
    runs: Mapping[str, Readings],
    variations: Mapping[str, Readings],
    faceted: Readings | None = None,
    tolerances: Tolerances | None = None,
) -> Budget:
    """Split the disagreement of ``runs["base"]`` with `exact` into its parts."""
    tolerances = Tolerances() if tolerances is None else tolerances
    kept = common_stations(exact, [*runs.values()], tolerances.snap_off_window)
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
    hard = "sharp" if "sharp" in run else "smooth"  # but for its contacts, which are harder next
    signals = {
        "discretisation": run["stiff"] - limit,
        "facets": run["calm"] - run["smooth"],
        "softness": (run[hard] - run["stiff"]) * STIFFER / (STIFFER - 1),
        "unrest": run["base"] - run["calm"],
        # What is out of balance shows in the sensors, too: that is unrest, and counted there.
        "sensor": _sensor(runs["calm"], shared),
        "extension": stretched(signatures, base.values("extension")[kept]),
    }
    if "sharp" in run:  # linear in the edges' radius
        signals["corner"] = (run["smooth"] - run["sharp"]) * SHARPER / (SHARPER - 1)
    total = shared.off(base)
    signals = with_unexplained(total, signals)
    sizes = {name: rms(part) for name, part in signals.items()}
    uncertainty = {
        "discretisation": np.hypot(SAFETY * (rms(finest - limit) + rms(limit - from_two)), doubt),
        "facets": sizes["unrest"],
        "softness": SAFETY * sizes["softness"] / (STIFFER - 1),
        "unrest": sizes["unrest"],
        "sensor": sizes["sensor"],
        "extension": sizes["extension"],
    }
    if "corner" in sizes:
        uncertainty["corner"] = SAFETY * sizes["corner"] / (SHARPER - 1)
    uncertainty["unexplained"] = root_of_squares(uncertainty.values())
    unresolved = np.hypot(uncertainty["unexplained"], UNRESOLVED)
    within = bool((sizes["unexplained"] <= unresolved).all())
    whole = rms(total)
    resolved = bool(
        (sizes["unexplained"] <= np.hypot(UNRESOLVED, _LEFT * whole)).all()
        and (uncertainty["unexplained"] <= np.hypot(UNRESOLVED, _UNSURE * whole)).all()
    )
    phase = exact.table["phase"].to_numpy()[kept]
    shifted = shifted_inward(
        signatures, base.values("penetration")[kept] / beam.length, beam.radius / beam.length
    )
    checks = {"softness": shifted}
    names = [name for name in PARTS if name in signals]
    if faceted is not None:
        # A vibrissa curved towards the object touches a straight facet twice, with no readings.
        solved = common_stations(exact, [faceted], tolerances.snap_off_window)[kept]
        if solved.any():
            checks["facets"] = shared.off(faceted)[:, solved]
    return Budget(
        parts_of(names, sizes, uncertainty),
        by_reading(total),
        {
            name: {
                reading: {str(p): float(rms(part[i, phase == p])) for p in np.unique(phase)}
                for i, reading in enumerate(CLAMP_READINGS)
            }
            for name, part in signals.items()
        },
        order,
        within and resolved,
        max(names, key=lambda name: float(np.linalg.norm(sizes[name]))),
        suspects(signals["unexplained"], signatures, float(np.linalg.norm(unresolved))),
        int(kept.sum()),
        convergence(exact, [runs[name] for name in REFINED], kept),
        {name: by_reading(check) for name, check in checks.items()},
        within and not resolved,
    )


def largest_rms(
    exact: Readings, candidate: Readings, tolerances: Tolerances | None = None
) -> float:
    """The largest of the three readings' disagreements, as a budget counts it."""
    window = (Tolerances() if tolerances is None else tolerances).snap_off_window
    kept = common_stations(exact, [candidate], window)
    return float(rms(Shared(exact, kept).off(candidate)).max())


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
    return np.asarray(limit), np.asarray(errors * np.linalg.norm(weights * power))


def _sensor(run: Readings, shared: Shared) -> Floats:
    """The sensors' discrepancy from the sum of the contacts, the worst of the three readings."""
    beam = run.beam
    units = np.array([beam.force_unit, beam.force_unit, beam.moment_unit])
    sizes = np.array([*scales(shared.exact).values()])
    return np.asarray((units / sizes)[:, None] * run.values("discrepancy")[shared.kept])
