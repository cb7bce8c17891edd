"""Budgets with planted numbers."""

from analytic import CLAMP_READINGS
from compare.explain.budget import Budget
from compare.explain.fit import Suspect
from compare.explain.parts import Part

PARTS = ("discretisation", "facets", "softness", "corner", "unrest", "sensor", "extension",
         "unexplained")  # fmt: skip


def planted(
    blame: str = "discretisation",
    size: float = 1e-3,
    unexplained: float = 2e-5,
    closes: bool = True,
    suspects: tuple[Suspect, ...] = (),
    undecided: bool = False,
) -> Budget:
    """One part of `size`, the others of next to nothing."""
    sizes = dict.fromkeys(PARTS, 1e-9) | {"extension": 0.0, "unexplained": unexplained}
    sizes[blame] = size
    parts = {
        name: {reading: Part(rms, rms / 10) for reading in CLAMP_READINGS}
        for name, rms in sizes.items()
    }
    by_phase = {
        name: {reading: {"tip": rms, "tangent": rms} for reading in CLAMP_READINGS}
        for name, rms in sizes.items()
    }
    convergence = {n: dict.fromkeys(CLAMP_READINGS, 1.6 / n**2) for n in (40, 80, 160)}
    checks = {"softness": dict.fromkeys(CLAMP_READINGS, 1e-9)}
    disagreement = dict.fromkeys(CLAMP_READINGS, size)
    return Budget(
        parts=parts,
        disagreement=disagreement,
        order=2.0,
        closes=closes,
        blame=blame,
        stations=190,
        by_phase=by_phase,
        suspects=suspects,
        convergence=convergence,
        checks=checks,
        undecided=undecided,
    )
