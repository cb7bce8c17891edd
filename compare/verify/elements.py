"""Rods in straight elements of constant strain: the simplest finite elements there are of them.

What a source computed with few elements is computed here with as many, so that what these make of
a difference is seen and not only said.
"""

import numpy as np
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from analytic.problem.arrays import Floats

_LOADS = 4  # steps to the whole load
_ITERATIONS = 60  # of the strains of one element, which shrink with its size
_SETTLED = 1e-14
_MISSED = 1e-10  # of the moments at the tip, relative to the loads'


def tip(
    nodes: Floats, stretching: Floats, bending: Floats, force: Floats, moment: Floats
) -> Floats:
    """Where the last node rests under dead loads there, by shooting from the clamped first one.

    One point of integration an element, Simo and Vu-Quoc 1986; compliances as a `Cantilever` has
    them, nodes in the plane z = 0.
    """
    chords = np.diff(nodes, axis=0)
    sizes = np.linalg.norm(chords, axis=1)
    along = chords / sizes[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(along))])
    frames = np.stack([along, across, np.broadcast_to([0, 0, 1], along.shape)], axis=2)
    scale = float(np.linalg.norm(force) * sizes.sum() + np.linalg.norm(moment))

    def march(moment_left: Floats, load: float) -> tuple[Floats, Floats]:
        place, turned = np.zeros(3), np.eye(3)
        for frame, size in zip(turned @ frames, sizes, strict=True):
            bent, now = np.zeros(3), turned @ frame
            for _ in range(_ITERATIONS):
                middle = now @ Rotation.from_rotvec(bent * size / 2).as_matrix()
                strain = np.eye(3)[0] + stretching * (middle.T @ (load * force))
                chord = size * (middle @ strain)
                before = bent
                bent = bending * (middle.T @ (moment_left - np.cross(chord / 2, load * force)))
                if np.abs(bent - before).max() * size < _SETTLED:
                    break
            turned = now @ Rotation.from_rotvec(bent * size).as_matrix() @ frame.T
            place, moment_left = place + chord, moment_left - np.cross(chord, load * force)
        return place, moment_left

    def missed(scaled: Floats, load: float) -> Floats:
        return np.asarray((march(scale * scaled, load)[1] - load * moment) / scale)

    scaled = np.zeros(3)
    for load in np.linspace(0, 1, _LOADS + 1)[1:]:
        scaled = root(missed, scaled, args=(load,), tol=1e-13).x
    if not np.abs(missed(scaled, 1.0)).max() <= _MISSED:
        raise ArithmeticError(f"{len(sizes)} elements do not come to rest")
    return march(scale * scaled, 1.0)[0]
