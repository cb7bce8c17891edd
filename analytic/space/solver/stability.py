r"""Whether an equilibrium in space is stable: the second variation of the energy, in closed form.

The contact is at rest where the energy E of the vibrissa is stationary among all shapes that keep
off the body, with the contact's force f as the multiplier. Let v be the displacement of the contact
along the surface, v1 in the plane of bending and v2 across it, omega the rotation of the vibrissa
there in that plane, and kappa the body's curvature (of the surface that the vibrissa's axis feels).

**Across the plane** the vibrissa is a pendulum of stiffness f sin(alpha)/X, X its reach: a turn
about the force changes no energy, so the variation is known (`analytic.from_clamp.sideways`).

**In the plane** K is the matrix of forces and moment by displacement and rotation of its end. The
closed form has it: a loaded part whose curvature vanishes a little beyond the contact is the same
family, shifted along the vibrissa.

**Phase A.** The tip is free to turn, so with K the two by two matrix of the tip

    Q = K11 v1^2 + (f sin(alpha)/X) v2^2 - f kappa(v, v).

**Phase B.** The vibrissa may also roll along the surface: the place where it touches is the one
nearest to the body. The distance of the point at s changes with s by nu = -omega + kappa11 v1 +
kappa12 v2 to first order and by kappa11 to second, since the vibrissa is straight there, so that
the nearest point is nu^2/(2 kappa11) nearer than the one that touched, and

    Q = K(v1, omega) + (f sin(alpha)/X) v2^2 - f kappa(v, v) + f nu^2/kappa11.

The terms in kappa11 v1^2 cancel, and a surface that is flat along the vibrissa fixes its slope. The
equilibrium is stable if Q is positive. On a prism that is alpha > 0; curvature across the plane
drops the vibrissa earlier.
"""

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.solver.contact import APART, Contact, loaded_part

_SHARPEST = 1e-12  # L, radius given to an edge when the vibrissa has none
_SLIGHT = 1e-2  # rad, of w: below, K is scaled, since rounding would swamp what is of order w^3
_FLATTEST = 1e-9  # 1/L, curvature given to a flat surface along the vibrissa


def second_variation(contact: Contact, radius: float) -> Floats:
    """The quadratic form Q in v1, v2 and, in Phase B, omega; dimensionless and symmetric."""
    force, alpha = contact.force, contact.plane.alpha
    k11, k12, k22 = _curvatures(contact, radius)
    swing = force * np.sin(alpha) / (contact.arc_length * contact.loaded.place[1])
    stiffness = _stiffness_of_any(contact)
    if not contact.tangent:
        bent = stiffness[0, 0] - force * k11
        return np.array([[bent, -force * k12], [-force * k12, swing - force * k22]])
    k11 = max(k11, _FLATTEST)
    rolling = force / k11
    return np.array(
        [
            [stiffness[0, 0], 0.0, stiffness[0, 2] - force],
            [0.0, swing - force * k22 + rolling * k12**2, -rolling * k12],
            [stiffness[0, 2] - force, -rolling * k12, stiffness[2, 2] + rolling],
        ]
    )


def is_stable(contact: Contact, radius: float) -> bool:
    """Whether the vibrissa returns, whichever way it is pushed: Q is positive."""
    form = second_variation(contact, radius)
    return bool(np.isfinite(form).all()) and margin(form) > 0


def margin(form: Floats) -> float:
    """The least eigenvalue of a quadratic form, its rows scaled by their size."""
    size = np.sqrt(np.abs(np.diag(form)))
    size = np.where(size > 0, size, 1.0)
    return float(np.linalg.eigvalsh(form / np.outer(size, size))[0])


def end_stiffness(contact: Contact) -> Floats:
    """Forces and moment of the end of the loaded part, by its displacement and rotation."""
    loaded, s, alpha = contact.loaded, contact.arc_length, contact.plane.alpha
    sine, cosine = np.sin(alpha), np.cos(alpha)
    # From (height, reach) to (along the surface, along the normal).
    turn = np.array([[sine, cosine], [-cosine, sine]])
    place = s * turn @ np.column_stack([loaded.by_rotation, loaded.by_alpha])
    # The force f n turns with alpha towards the surface, and grows with q^2.
    grows = 2 * contact.force * loaded.root_f_rates / loaded.root_f
    force = np.array([[0.0, contact.force], [grows[0], grows[1]]])
    if not contact.tangent:
        found = force @ np.linalg.inv(place)
        return np.asarray((found + found.T) / 2)
    longer = turn @ loaded.place - np.array([1.0, 0.0])
    ends = np.vstack([np.column_stack([place, longer]), [-1.0, 0.0, 0.0]])
    weaker = [0.0, -2 * contact.force / s]
    loads = np.vstack([np.column_stack([force, weaker]), [0.0, 0.0, -contact.force]])
    found = loads @ np.linalg.inv(ends)
    return np.asarray((found + found.T) / 2)


def _stiffness_of_any(contact: Contact) -> Floats:
    """K; of a hardly bent vibrissa, whose K grows as 1/w^2, by that at a larger w."""
    if contact.rotation >= _SLIGHT:
        return end_stiffness(contact)
    alpha = np.pi / 2 - _SLIGHT if contact.tangent else contact.plane.alpha
    more = contact._replace(
        plane=contact.plane._replace(alpha=alpha),
        loaded=loaded_part(_SLIGHT, alpha),
        rotation=_SLIGHT,
    )
    found = end_stiffness(more)
    found[0] *= _SLIGHT / contact.rotation
    found[:, 0] *= _SLIGHT / contact.rotation
    return found


def _curvatures(contact: Contact, radius: float) -> tuple[float, float, float]:
    """Of the surface that the vibrissa's axis feels: in the plane, mixed, across it."""
    sides = np.stack([contact.plane.along, contact.plane.across])
    turned, ways = np.linalg.eigh(sides @ contact.spot.turning @ sides.T)
    turned = np.clip(turned, 0.0, None)
    rounded = np.maximum(1 - (APART - radius) * turned, _SHARPEST * turned)
    bent = ways @ np.diag(turned / rounded) @ ways.T
    return float(bent[0, 0]), float(bent[0, 1]), float(bent[1, 1])
