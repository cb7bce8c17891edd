"""Fewer vertices for a finely meshed convex body, and what that costs."""

import numpy as np

from analytic.problem.arrays import Floats, Integers

_START = 4  # cells along an edge of the cube
_SAMPLE, _EACH = 50_000, 8  # points that are asked at least, and for each that is kept
_ROUNDS = 20  # the number of points about doubles in each
_NEAREST = 6  # faces that are asked whether a vertex lies outside of them
_ROUNDING = 1e-12  # of the body's size; as far outside is on the surface


def thinned(points: Floats, tolerance: float, most: int) -> tuple[Floats, float]:
    """Points of a convex surface such that their hull is nearly that of all."""
    if tolerance == 0 and len(points) <= most:
        return points, 0.0
    allowed = max(tolerance, _ROUNDING * float(np.ptp(points, axis=0).max()))
    kept, everyone = _farthest(points), np.arange(len(points))
    mixed, enough = np.random.default_rng(0).permutation(len(points)), False
    for _ in range(_ROUNDS):
        enough = enough or len(kept) == most
        asked = everyone if enough else np.sort(mixed[: max(_SAMPLE, _EACH * len(kept))])
        outside, face = _outside(points[asked], points[kept])
        miss = float(outside.max())
        if len(asked) == len(points) and (miss <= allowed or len(kept) == most):
            break
        enough = enough or miss <= allowed
        order = np.lexsort((-outside, face))
        worst = order[np.append(True, np.diff(face[order]) > 0)]
        worst = worst[outside[worst] > allowed]
        worst = worst[np.argsort(-outside[worst])][: most - len(kept)]
        kept = np.union1d(kept, asked[worst])
    else:
        miss = float(_outside(points, points[kept])[0].max())
    if miss > allowed and len(points) <= most:
        return points, 0.0
    return points[kept], miss if miss > allowed or tolerance > 0 else 0.0


def _farthest(points: Floats) -> Integers:
    """The point farthest out in each cell of a grid on each side of a cube."""
    middle = (points.max(axis=0) + points.min(axis=0)) / 2
    seen = (points - middle) / np.ptp(points, axis=0)  # a needle has as many cells all round
    side = np.argmax(np.abs(seen), axis=1)
    along = np.take_along_axis(seen, side[:, None], axis=1)
    others = np.take_along_axis(seen, np.array([[1, 2], [0, 2], [0, 1]])[side], axis=1)
    share = others / np.where(along == 0, 1, np.abs(along))
    cell = np.clip(((share + 1) / 2 * _START).astype(int), 0, _START - 1)
    key = ((2 * side + (along[:, 0] > 0)) * _START + cell[:, 0]) * _START + cell[:, 1]
    order = np.lexsort((-np.linalg.norm(seen, axis=1), key))
    return np.asarray(order[np.append(True, np.diff(key[order]) > 0)])


def _outside(points: Floats, kept: Floats) -> tuple[Floats, Integers]:
    from scipy.spatial import ConvexHull, KDTree  # slow to load

    middle, size = kept.mean(axis=0), np.ptp(kept, axis=0).max()
    hull = ConvexHull((kept - middle) / size)
    centres = KDTree(hull.points[hull.simplices].mean(axis=1))
    scaled = (points - middle) / size
    near = np.asarray(centres.query(scaled, k=min(_NEAREST, len(hull.simplices)))[1])
    most, face = np.full(len(points), -np.inf), near[:, 0].copy()
    for candidate in near.T:
        planes = hull.equations[candidate]
        distance = np.einsum("nd,nd->n", planes[:, :3], scaled) + planes[:, 3]
        farther = distance > most
        most[farther], face[farther] = distance[farther], candidate[farther]
    return np.maximum(most, 0) * size, face
