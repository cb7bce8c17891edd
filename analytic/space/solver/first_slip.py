r"""Which way a vibrissa that begins to touch a body slides.

While it is hardly bent its end follows F across the clamp's tangent by a third of it, so that with
a foot that moves by a' its point slides with v = a' + c e, n . v = 0. Friction may begin where it
is along v, v . (n x rub) = 0 and v . rub < 0; there may be several such directions, or none. Where
v is zero to first order, as across a prism with an upright clamp, what comes next decides.
"""

from collections.abc import Iterator

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import across
from analytic.space.problem.straight import StraightVibrissa
from analytic.space.solver.contact import APART, Scene
from analytic.space.solver.sliding import Sliding, state_of

_LOOKED_AT = 720  # directions
_ALIKE = 1e-9  # of the foot's speed
_BEFORE = 1e-13  # L of the way: touching, but not within


def first_slips(
    scene: Scene, way: StraightVibrissa, touch: float, friction: float
) -> Iterator[Sliding]:
    """States at first contact, still straight, by the direction of friction."""
    gap, onward = way.gap(touch - _BEFORE), way.onward(touch)
    normal = gap.spot.normal
    for tau in _directions(normal, scene.tangent, onward, friction):
        numbers = 0.0, gap.arc_length, touch
        force = normal + friction * tau
        place = gap.spot.point + APART * normal
        vector = np.concatenate([place, friction * tau, force, np.array(numbers)])
        yield state_of(scene, vector, gap.arc_length < 1)


def _directions(normal: Floats, t: Floats, onward: Floats, friction: float) -> Iterator[Floats]:
    """Of friction that is along the velocity, of a vibrissa that is pressed."""
    from scipy.optimize import brentq  # slow to load

    sides = across(normal)

    def both(angle: Floats) -> tuple[Floats, Floats]:
        """Of the velocity: across friction, and along it."""
        tau = np.stack([np.cos(angle), np.sin(angle)], axis=-1) @ sides
        bends = normal + friction * tau
        bends = bends - np.multiply.outer(bends @ t, t)
        presses = bends @ normal
        pressed = -(onward @ normal) / np.where(presses > 0, presses, np.nan)
        beside = np.cross(normal, tau)
        return tuple(w @ onward + pressed * (bends * w).sum(axis=-1) for w in (beside, tau))

    angles = np.linspace(0, 2 * np.pi, _LOOKED_AT + 1) + 1e-3
    values = both(angles)[0]
    for i in np.flatnonzero(values[:-1] * values[1:] < 0):
        root = np.asarray(brentq(lambda x: float(both(x)[0]), angles[i], angles[i + 1], xtol=1e-15))
        if both(root)[1] <= _ALIKE:
            yield np.array([np.cos(root), np.sin(root)]) @ sides
