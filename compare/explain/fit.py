"""Signatures laid over a disagreement: how large they are, what they leave, which are suspects."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from compare.explain.variations import STEP


class Fitted(NamedTuple):
    size: float
    left: float  # sum of squares that it leaves
    fraction: float  # of the disagreement's sum of squares that it accounts for


class Explanation(NamedTuple):
    """One mistake or fault, as it fits a disagreement best."""

    text: str  # what it is, with its size
    left: float  # sum of squares that it leaves
    sizes: int = 1  # how many numbers were fitted
    size: float = 0.0  # the one that was, if it is one


def fitted(error: Floats, signature: Floats) -> Fitted:
    """Fit the size of `signature` to `error` by least squares."""
    known = np.isfinite(signature).all(axis=0)
    s, e = signature[:, known].ravel(), error[:, known].ravel()
    weight, all_ = float(s @ s), float(e @ e)
    size = float(s @ e) / weight if weight > 0 else 0.0
    left = float(np.sum((e - size * s) ** 2))
    return Fitted(size, left, 1 - left / all_ if all_ > 0 else 0.0)


_UNITS = {
    "friction": "",
    "natural_curvature": "/L",
    "clamp_compliance": " L/EI",
    "clamp_angle": " rad",
}
_OF_ITSELF = ("flexural_rigidity", "length", "radius", "tip_radius")  # others are of L
_CONVINCING = 0.8  # fraction of the unexplained that a suspect must account for


@dataclass(frozen=True)
class Suspect:
    """A quantity of the physics that seems to differ between the two sweeps.

    `change` is by how much in the candidate, relative to its value (of a place, as ``foot_x``: to
    L; ``friction``: the coefficient itself; ``natural_curvature``: 1/L; ``clamp_compliance``, the
    clamp's rotation by its moment: L/EI; ``clamp_angle``: rad); `share` is how much of the
    unexplained disagreement's square it accounts for.
    """

    name: str
    change: float
    share: float

    @property
    def size(self) -> str:
        if self.name in _UNITS:
            return f"{self.change:+.2g}{_UNITS[self.name]}"
        return f"{self.change:+.2%}" + ("" if self.name in _OF_ITSELF else " of L")


def suspects(
    unexplained: Floats, signatures: Mapping[str, Floats], unresolved: float
) -> tuple[Suspect, ...]:
    """Which signatures account for the unexplained disagreement, the best first."""
    if np.linalg.norm(np.sqrt(np.mean(unexplained**2, axis=-1))) <= unresolved:
        return ()
    found = []
    for name, signature in signatures.items():
        size, _, fraction = fitted(unexplained, signature)
        if fraction >= _CONVINCING:
            found.append(Suspect(name, size * STEP, fraction))
    return tuple(sorted(found, key=lambda suspect: -suspect.share))
