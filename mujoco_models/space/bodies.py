"""The bodies of a sweep in space as MuJoCo's geoms: smooth primitives, and meshes as they are."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from analytic.space.problem.bodies.body import Body
from analytic.space.problem.bodies.ellipsoid import Ellipsoid
from analytic.space.problem.bodies.polyhedron import Polyhedron, polyhedron, solid
from analytic.space.problem.bodies.prism import Cylinder, Prism
from analytic.space.problem.bodies.support import SmoothBody, spread
from mujoco_models.model.spec import CCD_TOLERANCE
from mujoco_models.obstacles.protocol import GEOM, add_collider
from mujoco_models.obstacles.window import prism_faces

OUTLINE = "outline"
_MARGIN = 1.5  # L beyond the way of the foot: how far endless bodies go on
_MOST_VERTICES = 50_000  # the hull of a round body takes MuJoCo half a second then
# MuJoCo seeks the nearest point of an ellipsoid until its distance is good to a tolerance: of 1,800
# random points of six ellipsoids distances were off by 5.2 of these at most, and normals by 2.6
# times the angle by which the sharpest place recedes by one.
_OFF, _TURNED = 5.2, 2.6
_SHARPEST = 1e-4  # L, radius of curvature of a contour that a cylinder follows
_LARGEST = 10.0  # L, of such a cylinder: of a radius of 1,000 L MuJoCo's distances are off by 2e-8
_HALF_LENGTH = 50.0  # radii; the caps must be farther away than the centre
_DENSE = 4001  # parameters at which a contour is looked at for what is within reach


class Circle(NamedTuple):
    """A cylinder that touches a prism along one of its lines; lengths in L."""

    centre: Floats
    """A point of its axis, shape (3,)."""
    radius: float
    """That of the contour's circle of curvature, if it is no larger than `_LARGEST`."""
    flatter: float
    """Of its curvature that of the contour."""


Osculating: TypeAlias = Callable[[Floats], Circle]


@dataclass(frozen=True)
class Shape:
    """What MuJoCo has for a body."""

    label: str  # what provenance says of it
    mesh: Polyhedron | None = None  # what it is if it consists of flat faces [L]
    # The displacement by which the turning of a smooth body's normals is measured [L]: as small as
    # MuJoCo's precision allows.
    difference: float = 1e-5
    # Error of MuJoCo's normals [rad]: what a force leaves out of balance, and Newton's method
    # cannot remove.
    blur: float = 0.0
    off: float = 0.0  # error of its distances [L], likewise
    # Of a prism: maps a point near by to the cylinder that has the contour's circle of curvature
    # there. MuJoCo's cylinder follows the contact; where the rest of the body is, a mesh
    # says.
    osculating: Osculating | None = None
    inscribed: float = 0.0  # how far that mesh may be off the contour [L]


def add_body(
    spec: mujoco.MjSpec, body: Body, centre: Floats, reach: float, contour_points: int
) -> Shape:
    """Add a body to the world."""
    reach = reach + _MARGIN
    if isinstance(body, Ellipsoid):
        return _ellipsoid(spec, body)
    if isinstance(body, Cylinder):
        middle = body.through + ((centre - body.through) @ body.axis) * body.axis
        _add(spec, mujoco.mjtGeom.mjGEOM_CYLINDER, middle, body.axis, [body.radius, reach, 0])
        return Shape("MuJoCo's cylinder", difference=1e-4)
    if isinstance(body, Polyhedron):
        _add_mesh(spec, body)
        return Shape(f"mesh of {len(body.vertices)} vertices", body)
    if isinstance(body, Prism):
        return _prism(spec, body, centre, reach, contour_points)
    if isinstance(body, SmoothBody):
        normals = spread(contour_points)
        points = np.array([body.nearest(centre + 1e3 * n, 1.0).point for n in normals])
        mesh = polyhedron(points, body.label)
        _add_mesh(spec, mesh)
        return Shape(f"mesh of {len(points)} points of its surface", mesh)
    raise InputError(
        "body",
        type(body).__name__,
        "a sphere, ellipsoid, cylinder, prism, mesh or SmoothBody for MuJoCo",
        "give its points as a polyhedron",
    )


def _prism(
    spec: mujoco.MjSpec, body: Prism, centre: Floats, reach: float, contour_points: int
) -> Shape:
    """A mesh, and for the contact, if the contour has no corners, a cylinder that follows it."""
    line, alpha = _within_reach(body, centre, reach, contour_points)
    mesh = _extruded(body, line, centre, reach)
    grid = body.contour.at(body.contour.parameter(np.linspace(*alpha, _DENSE)))
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = grid.stretch / grid.turning
    if not (radius > _SHARPEST).all():
        _add_mesh(spec, mesh)
        return Shape(f"prism of a polygon of {len(line)} corners", mesh)
    _add_mesh(spec, mesh, OUTLINE)
    _add(spec, mujoco.mjtGeom.mjGEOM_CYLINDER, centre, body.frame[2], [1.0, _HALF_LENGTH, 0.0])

    def osculating(near: Floats) -> Circle:
        spot = body.nearest(near, 0.0)
        curvature = float(np.trace(spot.turning))
        size = 1 / max(curvature, 1 / _LARGEST)
        return Circle(spot.point - size * spot.normal, size, curvature * size)

    label = "MuJoCo's cylinder, with the contour's circle of curvature where the contact is"
    sagitta = float(np.hypot(*np.diff(line, axis=0).T).max()) ** 2 / (8 * float(radius.min()))
    return Shape(label, osculating=osculating, inscribed=sagitta)


def _ellipsoid(spec: mujoco.MjSpec, body: Ellipsoid) -> Shape:
    if np.ptp(body.semi_axes) == 0:
        _add(spec, mujoco.mjtGeom.mjGEOM_SPHERE, body.centre, None, [body.semi_axes[0], 0, 0])
        return Shape("MuJoCo's sphere")
    geom = _add(spec, mujoco.mjtGeom.mjGEOM_ELLIPSOID, body.centre, None, body.semi_axes)
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(body.frame.T).ravel())
    geom.quat = turn
    sharpest = float(body.semi_axes.max() / body.semi_axes.min() ** 2)
    blur = _TURNED * np.sqrt(CCD_TOLERANCE * sharpest)
    return Shape("MuJoCo's ellipsoid", None, 1e-3, blur, _OFF * CCD_TOLERANCE)


def _add(
    spec: mujoco.MjSpec,
    kind: mujoco.mjtGeom,
    place: Floats,
    axis: Floats | None,
    size: Floats | list[float],
) -> mujoco.MjsGeom:
    geom = add_collider(spec, kind, pos=place, size=size)
    if axis is not None:
        turn = np.zeros(4)
        mujoco.mju_quatZ2Vec(turn, axis)
        geom.quat = turn
    return geom


def _add_mesh(spec: mujoco.MjSpec, body: Polyhedron, name: str = GEOM) -> None:
    if len(body.vertices) > _MOST_VERTICES:
        raise InputError(
            f"body ({body.label})",
            f"of {len(body.vertices)} vertices",
            f"of at most {_MOST_VERTICES:,} for MuJoCo",
            "simplify it (tolerance)",
        )
    mesh = spec.add_mesh(name=name)
    mesh.uservert, mesh.userface = body.vertices.ravel(), body.faces.astype(np.int32).ravel()
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
    kind, touches = mujoco.mjtGeom.mjGEOM_MESH, int(name == GEOM)
    add_collider(spec, kind, name, meshname=name, contype=touches)


def _within_reach(
    body: Prism, centre: Floats, reach: float, points: int
) -> tuple[Floats, tuple[float, float]]:
    """A polygon inscribed in the part of a prism's contour within reach, and its slope angles."""
    x, y, _ = body.frame @ (centre - body.origin)
    t = np.linspace(*body.contour.t_range, _DENSE)
    there = body.contour.at(t)
    near = np.flatnonzero(np.hypot(there.xi - x, there.eta - y) < reach)
    first, last = max(near[0] - 1, 0), min(near[-1] + 1, len(t) - 1)
    line = body.contour.outline(float(t[first]), float(t[last]), points)
    return line, (float(there.alpha[first]), float(there.alpha[last]))


def _extruded(body: Prism, line: Floats, centre: Floats, reach: float) -> Polyhedron:
    """Its sides drawn up from the ends of its contour: a counterclockwise polygon, twice."""
    _, y, along = body.frame @ (centre - body.origin)
    top = np.full(2, max(line[:, 1].max(), y) + reach)
    line = np.concatenate([line, np.column_stack([line[[-1, 0], 0], top])])
    both = [np.column_stack([line, np.full(len(line), along + side)]) for side in (-reach, reach)]
    points = body.origin + np.concatenate(both) @ body.frame
    along = np.roll(line, -1, axis=0) - line
    outward = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    planes = np.round(outward, 9) @ body.frame[:2]  # alike where corners lie on one line
    ends = np.repeat([-body.frame[2], body.frame[2]], len(line) - 2, axis=0)
    normals = np.concatenate([planes, planes, ends])
    return solid(points, prism_faces(len(line)), normals, body.label)
