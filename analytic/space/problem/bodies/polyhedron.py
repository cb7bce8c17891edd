"""A convex mesh: faces, edges and corners, each with the normals that it has."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from pathlib import Path

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.numerics.vectors import cross
from analytic.problem.contours.mesh_file import hull_of, read_body
from analytic.problem.errors import InputError
from analytic.problem.numbers import Vector, floats, positive, vector, within
from analytic.space.problem.bodies.body import Body, Feature, Spot, flat_spot

_ON_PLANE = 1e-9  # of the extent: so near to a plane a point is on it
_PARALLEL = 1e-9  # rad; a step that rises less from a plane is along it, and such faces are one
_TIED = 1e-14  # of a square of a distance: so near to each other rounding decides


@dataclass(frozen=True, eq=False)
class Polyhedron(Body):
    """A bounded convex mesh; made by `convex_mesh` and `polyhedron`."""

    vertices: Floats  # shape (n, 3) [length]
    faces: Integers  # triangles of vertices, shape (m, 3)
    # Outward, of length 1, exactly alike on triangles of one plane, shape (m, 3).
    normals: Floats = field(repr=False)
    label: str  # what reports call it

    @cached_property
    def corners(self) -> Floats:
        """Corners of the triangles, shape (m, 3, 3) [length]."""
        return self.vertices[self.faces]

    @cached_property
    def heights(self) -> Floats:
        """Distance of each triangle's plane from the origin, shape (m,) [length]."""
        return np.asarray((self.normals * self.corners.mean(axis=1)).sum(axis=1))

    @cached_property
    def _sides(self) -> Floats:
        """From each corner of a triangle to the next one, shape (m, 3, 3) [length]."""
        return np.roll(self.corners, -1, axis=1) - self.corners

    @cached_property
    def _squares(self) -> Floats:
        """Of their lengths, shape (m, 3)."""
        return np.asarray((self._sides**2).sum(axis=2))

    @cached_property
    def _around(self) -> tuple[Integers, Integers]:
        """The triangles at each vertex: where they begin in the list, and the list."""
        order = np.argsort(self.faces.ravel(), kind="stable")
        begins = np.searchsorted(self.faces.ravel()[order], np.arange(len(self.vertices) + 1))
        return begins, order // 3

    @property
    def smooth(self) -> bool:
        return False

    def nearest(self, x: Floats, apart: float) -> Spot:
        """Walks over the triangles that the point sees, always to a nearer one."""
        ahead = self.normals @ x - self.heights
        face = int(np.argmax(ahead))
        if ahead[face] <= 0:
            return flat_spot(x, self.normals[face], float(ahead[face]))
        tried = np.array([face])
        best = np.inf
        while True:
            found, weights = self._nearest_on(tried, x)
            far = ((found - x) ** 2).sum(axis=1)
            nearest = int(np.argmin(far))
            if not far[nearest] < best:
                break
            best, face = float(far[nearest]), int(tried[nearest])
            point, weight = found[nearest], weights[nearest]
            if (weight > 0).all():  # within a face, behind whose plane all of the body is
                break
            tried = self._neighbours(face)
            tried = tried[ahead[tried] > 0]
        # Next to an edge distances drown in rounding: which side the point is on decides.
        tied = np.flatnonzero(far <= (1 + _TIED) * best)
        if len(tied) > 1 and not (weight > 0).all():
            beyond = self._beyond(tried, x, found[tied])
            chosen = tied[int(np.argmin(beyond))]
            face, point, weight = int(tried[chosen]), found[chosen], weights[chosen]
        return self._spot(x, face, point, weight, apart, float(ahead[face]))

    def _nearest_on(self, tried: Integers, x: Floats) -> tuple[Floats, Floats]:
        """Nearest points of triangles (Ericson, Real-Time Collision Detection, 2005, 5.1.5)."""
        corners, sides, squares = self.corners[tried], self._sides[tried], self._squares[tried]
        away, each = x - corners, np.arange(len(tried))
        d11, d12, d22 = squares[:, 0], -(sides[:, 0] * sides[:, 2]).sum(1), squares[:, 2]
        along = (away * sides).sum(2)
        e1, e2 = along[:, 0], -(away[:, 0] * sides[:, 2]).sum(1)
        area = d11 * d22 - d12 * d12
        v, w = (d22 * e1 - d12 * e2) / area, (d11 * e2 - d12 * e1) / area
        within = np.stack([1 - v - w, v, w], axis=1)
        shares = np.clip(along / squares, 0, 1)
        side = ((shares[..., None] * sides - away) ** 2).sum(2).argmin(axis=1)
        share = shares[each, side]
        edge = np.zeros_like(within)
        edge[each, side], edge[each, side - 2] = 1 - share, share
        weights = np.where((within > 0).all(axis=1, keepdims=True), within, edge)
        return np.einsum("nk,nkc->nc", weights, corners), weights

    def _beyond(self, tried: Integers, x: Floats, points: Floats) -> Floats:
        """How much nearer points of some triangles are than the plane through each allows."""
        others = self.corners[tried].reshape(-1, 3)
        away = x - points
        return np.asarray((away @ others.T).max(axis=1) - (away * points).sum(axis=1))

    def _neighbours(self, face: int) -> Integers:
        begins, triangles = self._around
        parts = [triangles[begins[v] : begins[v + 1]] for v in self.faces[face]]
        return np.concatenate(parts)

    def _spot(
        self, x: Floats, face: int, point: Floats, weight: Floats, apart: float, height: float
    ) -> Spot:
        on = weight > 0
        if on.all():
            return flat_spot(x, self.normals[face], height)
        away = x - point
        distance = float(np.linalg.norm(away))
        normal = away / distance
        flat = np.eye(3) - np.outer(normal, normal)
        if on.sum() == 2:
            first, second = self.corners[face][on]
            along = (second - first) / np.linalg.norm(second - first)
            if self._is_flat(self.faces[face][on], face):
                return flat_spot(x, self.normals[face], height)
            # An edge: the normal turns about it, and that only.
            flat = flat - np.outer(along, along)
        return Spot(point, normal, distance, flat / apart)

    def _is_flat(self, edge: Integers, face: int) -> bool:
        """Whether the triangles on both sides of an edge lie in one plane."""
        begins, triangles = self._around
        one, other = (triangles[begins[v] : begins[v + 1]] for v in edge)
        both = np.intersect1d(one, other)
        return bool((self.normals[both] == self.normals[face]).all())

    def features(self, point: Floats, off: float = 0.0) -> tuple[list[Feature], list[Feature]]:
        """Faces at a point of the surface, or that miss it by `off`, and the edges between them."""
        on = np.abs(self.normals @ point - self.heights) < self._rounding + off
        normals = np.unique(self.normals[on], axis=0)
        faces, edges = [Feature(point, np.zeros((0, 3)), n) for n in normals], []
        for one, other in combinations(normals, 2):
            across, apart = one + other, one - other
            size = float(np.linalg.norm(apart))
            ahead = normals @ cross(one, other)  # behind all other faces, on one side at least
            slack = _PARALLEL * size
            if size > _PARALLEL and ((ahead <= slack).all() or (ahead >= -slack).all()):
                normal = across / np.linalg.norm(across)
                edges.append(Feature(point, np.stack([normal, apart / size]), normal))
        return faces, edges

    def snapped(self, point: Floats, within: float) -> Floats:
        """The corner near a point of the surface, else the place on an edge, else itself."""
        away = np.linalg.norm(self.vertices - point, axis=1)
        corner = int(np.argmin(away))
        if away[corner] <= within:
            return np.asarray(self.vertices[corner])
        left = self.heights - self.normals @ point
        normal = self.normals[int(np.argmin(left))]
        along = self.normals - np.outer(self.normals @ normal, normal)
        size = np.linalg.norm(along, axis=1)
        left = np.divide(left, size, out=np.full_like(left, np.inf), where=size > _PARALLEL)
        edge = int(np.argmin(left))
        if left[edge] > within:
            return point
        return np.asarray(point + left[edge] / size[edge] * along[edge])

    def room(self, point: Floats, step: Floats) -> float:
        """How much of a step along a face or an edge stays on it, from 0 to 1."""
        towards = self.normals @ step
        ahead = towards > _PARALLEL * float(np.linalg.norm(step))
        if not ahead.any():
            return 1.0
        left = (self.heights - self.normals @ point)[ahead] / towards[ahead]
        return float(np.clip(left.min(), 0.0, 1.0))

    @cached_property
    def _rounding(self) -> float:
        return _ON_PLANE * float(np.abs(self.vertices).max())

    def with_vertices(self, vertices: Floats) -> "Polyhedron":
        """The same mesh, its vertices elsewhere by rounding; normals that are alike stay so."""
        _, first, of_plane = np.unique(self.normals, axis=0, return_index=True, return_inverse=True)
        one, other, third = vertices[self.faces].swapaxes(0, 1)
        areas = np.cross(other - one, third - one)
        planes = np.zeros((len(first), 3))
        np.add.at(planes, of_plane, areas)
        planes /= np.linalg.norm(planes, axis=1)[:, None]
        return replace(self, vertices=vertices, normals=planes[of_plane])

    def scaled(self, factor: float) -> "Polyhedron":
        return replace(self, vertices=factor * self.vertices)

    def patches(self, centre: Floats, reach: float) -> Floats:
        return self.corners


def convex_mesh(
    file: str | Path,
    *,
    scale: float = 1.0,
    offset: Vector = (0.0, 0.0, 0.0),
    hull: bool = False,
    tolerance: float = 0.0,
) -> Polyhedron:
    """A convex body from a mesh file.

    Vertices at one place are merged, a mesh that is inside out is turned. A body of more than
    50,000 vertices is thinned to that number at most, and its label says how far outside those lie
    that are left out.

    Parameters
    ----------
    file : str or Path
        STL, OBJ, PLY, OFF, GLB or glTF.
    scale : float
        The file's unit of length, in the case's [length].
    offset : array_like, shape (3,)
        Where the file's origin is put, after scaling [length].
    hull : bool
        Whether to take the convex hull of an open or dented mesh.
    tolerance : float
        How far vertices may lie outside the body, so that it has fewer [length].

    Returns
    -------
    Body
        The body.

    Raises
    ------
    InputError
        If the file cannot be read, its mesh is flat or, unless `hull`, open or dented.
    """
    unit = positive("body.scale", scale)
    place = vector("body.offset", offset)
    tolerance = within("body.tolerance", tolerance, 0.0)
    body = read_body(file, hull, tolerance / unit)
    label = Path(file).name
    if body.miss > 0:
        label += f", simplified within {body.miss * unit:.1e}"
    return solid(unit * body.vertices + place, body.faces, body.normals, label)


def polyhedron(points: Floats, label: str = "polyhedron") -> Polyhedron:
    """The convex hull of points.

    Parameters
    ----------
    points : array, shape (n, 3)
        Four or more, not in one plane [length].
    label : str
        What reports call it.

    Returns
    -------
    Body
        The body.

    Raises
    ------
    InputError
        If they have no volume.
    """
    from scipy.spatial import QhullError  # slow to load, and few cases need it

    try:
        found, _ = hull_of(floats("body.points", points, (None, 3), "points (x, y, z)"))
    except QhullError as error:
        what = f"not usable ({error!s:.80})"
        allowed, remedy = "four points or more with a volume", "an array of shape (n, 3)"
        raise InputError("body.points", what, allowed, remedy) from error
    return solid(found.vertices, found.faces, found.normals, label)


def solid(vertices: Floats, faces: Integers, normals: Floats, label: str) -> Polyhedron:
    """A mesh of triangles of any sense, some perhaps without area, turned outwards."""
    one, other, third = vertices[faces].swapaxes(0, 1)
    sides = np.stack([other - one, third - other, one - third])
    areas = np.cross(sides[0], sides[1])
    outward = (areas * normals).sum(axis=1, keepdims=True) > 0
    faces = np.where(outward, faces, faces[:, ::-1])
    kept = np.linalg.norm(areas, axis=1) > 1e-12 * (sides**2).sum(axis=2).max(axis=0)
    return Polyhedron(vertices, faces[kept], normals[kept], label)
