"""What varies along a vibrissa, dimensionless, and the panels on which polynomials resolve it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np

from analytic.numerics.panel import NODES, POINTS, TO_SERIES, WEIGHTS, Panel
from analytic.problem.along import Along, rescaled
from analytic.problem.arrays import Floats
from analytic.problem.beam import Beam
from analytic.problem.unloaded import Unloaded

_TAIL = 2  # coefficients
_EXACT = 1e-8  # of a panel's largest value; of the integral over it then the square
_HALVINGS = 12
_PLACES = 257
_KNOWN = 512  # panels: a sweep of a stiff vibrissa asks for some ten, a calibration for a hundred


@dataclass(frozen=True)
class RodProperties:
    unloaded: Unloaded  # natural curvature and radius
    # EI(s)/EI(0); or the ratio of a cone's radii, whose fourth power it follows.
    rigidity: Along | float
    # Exponent of the rigidity: 1, or less on the way from the uniform vibrissa to this one.
    share: float = 1.0
    weight: tuple[float, float] = (0.0, 0.0)  # along x and y, by length [EI(0)/L^3]

    @classmethod
    def of(
        cls, beam: Beam, rest: Unloaded, weight: tuple[float, float] = (0.0, 0.0)
    ) -> "RodProperties":
        w_x, w_y = (w * beam.length / beam.force_unit for w in weight)
        rigidity: Along | float = rest.tip_radius / rest.base_radius if rest.base_radius else 1.0
        if isinstance(beam.flexural_rigidity, Along):
            rigidity = beam.flexural_rigidity.times(1 / beam.base_rigidity, 1 / beam.length)
        return cls(rest, rigidity, weight=(w_x, w_y))

    def scaled(self, share: float) -> "RodProperties":
        """The form a part of the way from the uniform, straight vibrissa to this one."""
        rest = self.unloaded
        less = rescaled(rest.natural, share)
        base = rest.tip_radius + share * (rest.base_radius - rest.tip_radius)
        less_leant = replace(rest, natural=less, base_radius=base, angle=share * rest.angle)
        w_x, w_y = self.weight
        less_heavy = share * w_x, share * w_y
        return replace(self, unloaded=less_leant, share=share, weight=less_heavy)

    def flexibility(self, s: Floats) -> Floats:
        """EI(0)/EI(s)."""
        if isinstance(self.rigidity, Along):
            inverse = 1 / self.rigidity(s)
            return inverse if self.share == 1 else inverse**self.share
        inverse = 1 / (1 - (1 - self.rigidity) * s) ** 2
        return np.asarray(inverse**2 if self.share == 1 else inverse ** (2 * self.share))

    def panel(self, begin: Floats, end: Floats) -> Panel:
        return Panel.between(begin, end, self.flexibility, self.unloaded.curvature)

    @cached_property
    def known_panel(self) -> Callable[[float, float], Panel]:
        """The form between two places that many spans run through, the last ones computed once."""
        return lru_cache(_KNOWN)(lambda *ends: self.panel(*np.reshape(ends, (2, 1))))

    @cached_property
    def ends(self) -> Floats:
        """Arc lengths between which the form is smooth and resolved, from 0 to 1 [L]."""
        given = self.rigidity, self.unloaded.natural
        marks = {0.0, 1.0}
        for along in given:
            if isinstance(along, Along):
                marks |= set(along.ends[1:-1])
        ends, ahead = [0.0], sorted(marks)[:0:-1]
        least = 0.5**_HALVINGS
        while ahead:
            begin, end = ends[-1], ahead[-1]
            if end - begin < least or self._is_resolved(begin, end):
                ends.append(ahead.pop())
            else:
                ahead.append((begin + end) / 2)
        return np.array(ends)

    @cached_property
    def phases(self) -> Floats:
        """The pendulum's phase between two ends under a force of 1, nearly; shape (panels,)."""
        share, widths = np.linspace(0, 1, NODES)[:, None], np.diff(self.ends)
        flexible = self.flexibility(self.ends[:-1] + share * widths)
        return np.asarray(widths * np.sqrt(flexible.max(axis=0)))

    @cached_property
    def least_force(self) -> float:
        """Force across the tip that turns it by half a radian, if that were little; at most 1."""
        turn = 0.0
        for begin, end in pairwise(self.ends):
            s = begin + (end - begin) * POINTS
            turn += float((end - begin) * (WEIGHTS @ ((1 - s) * self.flexibility(s))))
        return min(1.0, 0.5 / turn)

    @cached_property
    def most_curved(self) -> float:
        return float(self.unloaded.curvature(np.linspace(0, 1, _PLACES)).max())

    def _is_resolved(self, begin: float, end: float) -> bool:
        s = begin + (end - begin) * POINTS
        natural = self.unloaded.curvature(s)
        for values, least in ((self.flexibility(s), 0.0), (natural, 1.0)):
            series = np.abs(TO_SERIES @ values)
            if series[-_TAIL:].max() > _EXACT * max(least, np.abs(values).max()):
                return False
        return True
