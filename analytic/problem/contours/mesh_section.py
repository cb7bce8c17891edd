"""The section of a convex mesh file by the plane of the sweep."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.contours.contour import ConvexMesh
from analytic.problem.contours.mesh_file import MeshBody, read_body
from analytic.problem.contours.polygon import Polygon, polygon
from analytic.problem.errors import InputError
from analytic.problem.numbers import finite, pair, positive, within

_IN_PLANE = 1e-6  # of the mesh's extent: files hold single precision
_SAME = 1e-9  # of the section's extent; corners closer than that are one
_STRAIGHT = 1e-9  # rad; corners that turn less are what rounding leaves of an edge


def mesh_section(
    file: str | Path,
    scale: float = 1.0,
    offset: tuple[float, float] = (0.0, 0.0),
    height: float = 0.0,
    axes: str = "xy",
    hull: bool = False,
    tolerance: float = 0.0,
) -> Polygon:
    """The polygon in which the plane of the sweep cuts a convex mesh.

    It knows the mesh that it is cut from (``solid``), and how far the mesh's normals leave the
    plane there (``solid.tilt``): a bead of radius r touches a face that is tilted by t at the
    distance r/cos(t) from the section, and is pushed out of the plane. ``solid.gap(r)`` is what
    that amounts to; where it is not small the section is another problem than the body.

    Parameters
    ----------
    file : str or Path
        STL, OBJ, PLY, OFF, GLB or glTF. Vertices at one place are merged; a body of more than
        50,000 vertices is simplified, and its label says by how much.
    scale : float
        From the file's unit of length to the case's.
    offset : tuple of float
        Where the file's origin goes, after scaling [length].
    height : float
        Of the plane along the third axis, in the file's unit.
    axes : str
        The mesh's axes that become x and y of the sweep: ``"xy"``, ``"xz"``, ``"zy"``, ...
    hull : bool
        Whether to take the convex hull of a mesh that is open or dented.
    tolerance : float
        How far the file's vertices may lie outside the body, so that it has fewer, in the file's
        unit; 0 keeps all that are on the hull.

    Returns
    -------
    Polygon
        The lower side of the section.

    Raises
    ------
    InputError
        If a number cannot be, the file cannot be read, its mesh is flat, open or not convex, or the
        plane misses it.
    """
    if not isinstance(axes, str) or sorted(axes) not in ([*"xy"], [*"xz"], [*"yz"]):
        raise InputError("mesh axes", repr(axes), "two of x, y and z", "'xy' is usual")
    scale = positive("mesh scale", scale)
    shift = np.array(pair("mesh offset", offset))
    height = finite("mesh height", height)
    tolerance = within("mesh tolerance", tolerance, 0.0, remedy="0 keeps all")
    body, name = read_body(file, hull, tolerance), Path(file).name
    third = ({"x", "y", "z"} - set(axes)).pop()
    across = ["xyz".index(axis) for axis in (*axes, third)]
    low, high = (float(end(body.vertices[:, across[2]])) for end in (np.min, np.max))
    plane = f"height {height:g} of the plane through {file}"
    if not low < height < high:
        what = f"outside {low:.6g}..{high:.6g} along {third}"
        raise InputError(plane, what, "between the mesh's ends there", "move the plane")
    turned = np.rint(np.linalg.det(np.eye(3)[across]))  # or the body became its mirror image
    points = (body.vertices[:, across] - [0, 0, height]) * [1, 1, turned]
    corners = _corners(_cut(points, body.faces) * scale + shift)
    if len(corners) < 3:
        raise InputError(plane, "only touching the mesh", "where it cuts the mesh", "move it")
    label = f"section of {name}"
    if body.miss > 0:
        label += f", simplified within {body.miss * scale:.1e}"
    solid = ConvexMesh(points * scale + [*shift, 0], _tilt(body, points, across), name)
    return replace(polygon(corners, label), solid=solid)


def _cut(points: Floats, faces: Integers) -> Floats:
    """Where the edges pass z = 0, and the vertices there, shape (n, 2)."""
    edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    one, other = edges[points[edges, 2].prod(axis=1) < 0].T
    share = (points[one, 2] / (points[one, 2] - points[other, 2]))[:, None]
    crossing = points[one, :2] + share * (points[other, :2] - points[one, :2])
    return np.concatenate([crossing, points[points[:, 2] == 0, :2]])


def _corners(points: Floats) -> Floats:
    """Those of the convex hull of points of the plane, in order; fewer than 3 if it is none."""
    from scipy.spatial import ConvexHull, QhullError  # slow to load

    extent = float(np.ptp(points, axis=0).max()) if len(points) > 2 else 0.0
    if extent == 0:
        return points[:0]
    try:
        corners = points[ConvexHull((points - points.mean(axis=0)) / extent).vertices]
    except QhullError:
        return points[:0]
    while len(corners) >= 3:
        ahead = np.roll(corners, -1, axis=0) - corners
        behind = np.roll(ahead, 1, axis=0)
        turn = behind[:, 0] * ahead[:, 1] - behind[:, 1] * ahead[:, 0]
        straight = turn <= _SAME**2 * extent**2
        straight |= turn <= _STRAIGHT * np.hypot(*ahead.T) * np.hypot(*behind.T)
        if not straight.any():
            break
        first = int(np.argmin(np.where(straight, turn, np.inf)))  # one at a time: both ends of a
        corners = np.delete(corners, first, axis=0)  # short edge may be straight
    return corners


def _tilt(body: MeshBody, points: Floats, across: list[int]) -> float:
    """Largest component of the normals across the plane, along the section's lower side."""
    up, third = body.normals[:, across[1:]].T
    above = np.where(np.abs(points[:, 2]) < _IN_PLANE * np.ptp(points), 0, points[:, 2])
    sides = above[body.faces]
    cut = (sides.min(axis=1) < 0) & (sides.max(axis=1) > 0) & (up < 0)
    ends = sides[:, [[1, 2], [2, 0], [0, 1]]]  # of the edge across from each vertex
    face, edge = np.nonzero((ends == 0).all(axis=2))
    pairs = np.column_stack([face, body.neighbours[face, edge]])
    pairs = pairs[up[pairs].sum(axis=1) < 0]
    one_way = third[pairs].prod(axis=1) > 0
    tilts = [*np.abs(third[cut]), *np.abs(third[pairs[one_way]]).min(axis=1)]
    face, edge = np.nonzero(cut[:, None] & (ends.prod(axis=2) < 0) & (up[body.neighbours] >= 0))
    begin, end = body.faces[face, edge - 2], body.faces[face, edge - 1]
    x, _, z = (points[end] - points[begin]).T
    return float(max([*tilts, *(np.abs(x) / np.hypot(x, z))], default=0.0))
