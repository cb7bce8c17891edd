"""The second variation of a vibrissa's energy in space, by finite elements and the body's distance.

Shares nothing with the closed form but the state: the shape is integrated from the clamp, the
body's distance is differentiated numerically, and all variations of the shape are free.
"""

import numpy as np

from analytic.space.checks.rod import integrate_rod

ELEMENTS = 100
_STEP = 1e-5  # L, of the differences of the body's distance


def least_eigenvalue(gradient, tangent, state, elements=ELEMENTS):
    """Of the energy's second variation, with the contact kept on the body's surface.

    Variations turn the tangent by (a, b): in the plane of bending and out of it. They are linear in
    each element and vanish at the clamp. The energy less the force times the distance is varied
    twice; a tangential contact may roll, which adds the square of the distance's change along the
    vibrissa over twice its curvature there.
    """
    foot, force, moment, reach, normal, tangential = state
    place, along, bending = integrate_rod(tangent, force, moment, reach, 2 * elements + 1)
    push = -force  # of the body
    across = np.cross(normal - (normal @ tangent) * tangent, tangent)
    across /= np.linalg.norm(across)
    sides = np.cross(across, along)  # in the plane of bending
    h = reach / elements
    count = 2 * elements
    matrix = np.zeros((count, count))
    rows_d = np.zeros((3, count))  # displacement of the contact
    kappa2 = (np.cross(along, bending) ** 2).sum(axis=1)
    pull = along @ push
    for e in range(elements):
        nodes = (e, e + 1)
        for share, weight in ((0, 1 / 6), (1, 4 / 6), (2, 1 / 6)):
            i = 2 * e + share
            shape = (1 - share / 2, share / 2)
            slope = (-1 / h, 1 / h)
            for one in range(2):
                if nodes[one] == 0:
                    continue
                row = 2 * (nodes[one] - 1)
                rows_d[:, row] += weight * h * shape[one] * sides[i]
                rows_d[:, row + 1] += weight * h * shape[one] * across
                for two in range(2):
                    if nodes[two] == 0:
                        continue
                    column = 2 * (nodes[two] - 1)
                    stiff = weight * h * slope[one] * slope[two]
                    mass = weight * h * shape[one] * shape[two]
                    # |t'|^2 to second order, and the shortening (a^2 + b^2)/2 under the push.
                    matrix[row, column] += stiff + pull[i] * mass
                    matrix[row + 1, column + 1] += stiff + (pull[i] - kappa2[i]) * mass
    size = np.linalg.norm(push)
    hessian = _hessian(gradient, foot + place[-1])
    matrix -= size * rows_d.T @ hessian @ rows_d
    if tangential:
        curvature = along[-1] @ hessian @ along[-1]
        change = along[-1] @ hessian @ rows_d
        change[-2] += normal @ sides[-1]
        change[-1] += normal @ across
        matrix += size / max(curvature, 1e-9) * np.outer(change, change)
    constraint = normal @ rows_d
    kept = np.linalg.svd(constraint[None])[2][1:]
    return float(np.linalg.eigvalsh(kept @ matrix @ kept.T)[0])


def _hessian(gradient, at):
    """Second derivatives of the distance from the body, by differences of its gradient."""
    found = np.zeros((3, 3))
    for i in range(3):
        ahead, behind = at.copy(), at.copy()
        ahead[i] += _STEP
        behind[i] -= _STEP
        found[i] = (gradient(ahead) - gradient(behind)) / (2 * _STEP)
    return (found + found.T) / 2
