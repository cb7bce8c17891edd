"""Cases with contours, vibrissae and bodies that are drawn at random; lengths in L."""

from typing import Any, TypeAlias

import numpy as np
import trimesh

import analytic as plane
from analytic import space

Draw: TypeAlias = np.random.Generator
MESHES = ("ball", "box", "capsule", "hull")
CONTOURS = ("catenary", "parabola", "circle", "ellipse", "two-circles", "points", "own")
VIBRISSAE = (
    *("friction", "soft", "curved", "towards", "taper", "graded", "bowed", "mixed", "whisker"),
)
BODIES = ("sphere", "ellipsoid", "cylinder", "prism", "polyhedron", "smooth", *MESHES)


def planar(shape: str, kind: str, stations: int, draw: Draw) -> plane.Case:
    """A drawn vibrissa past a drawn contour; one in units has the object scaled with it."""
    given, object_ = vibrissa(kind, draw), contour(shape, draw)
    length = given.get("beam", plane.Beam()).length
    sweep = plane.Sweep(stations, direction="left" if draw.random() < 0.7 else "right")
    return plane.Case(profile=object_.scaled(length), sweep=sweep, **given)


def contour(kind: str, draw: Draw) -> plane.Contour:
    """Its lowest point is 0.3 to 0.6 L above the foot's line, its top above the vibrissa's."""
    low, r, e = draw.uniform(0.3, 0.6), draw.uniform(0.8, 1.3), draw.uniform(-0.5, 0.5)
    lowest = (0.0, low)
    if kind in MESHES:
        made, height = mesh(kind, draw, np.eye(3)), 0.05 * r  # not through the vertices
        made.export("section.stl")
        cut: Any = made.section(plane_origin=(0, 0, height), plane_normal=(0, 0, 1))
        offset = (0.0, low - cut.bounds[0][1])
        return plane.mesh_section("section.stl", offset=offset, height=height)
    if kind == "polygon":
        angles = np.sort(draw.uniform(0, 2 * np.pi, draw.integers(5, 13)))
        x, y = r * np.cos(angles), r * draw.uniform(0.8, 1) * np.sin(angles)
        return plane.polygon(np.column_stack([x, y - y.min() + low]))
    x = np.linspace(-1.5, 1.5, 25) + draw.uniform(-0.02, 0.02, 25)
    own = plane.Profile(  # its radius of curvature is r (1 + e cos 2 alpha)
        xi=lambda a: r * (np.sin(a) + e * (np.sin(3 * a) / 6 + np.sin(a) / 2)),
        eta=lambda a: low - r * (np.cos(a) - 1 + e * (np.cos(3 * a) / 6 - np.cos(a) / 2 + 1 / 3)),
        alpha_range=(-1.4, 1.4),
    )
    return {
        "catenary": plane.catenary(r, low - 1),
        "parabola": plane.parabola(r, low),
        "circle": plane.circle(r, lowest),
        "ellipse": plane.ellipse((r, 1 + e / 3), lowest),
        "two-circles": plane.two_circles(r, 1.3 + e, lowest),
        "points": plane.through_points(np.column_stack([x, low + r * x**2 / 2])),
        "own": own,
    }[kind]


def vibrissa(kind: str, draw: Draw) -> dict[str, Any]:
    """What a `Case` takes of it: its beam, its clamp, its friction."""
    u, beam = draw.uniform(), plane.Beam
    friction, soft = {"friction": 0.05 + 0.5 * u}, {"clamp_stiffness": 2 + 60 * u**2}
    curved = {"beam": beam(natural_curvature=-0.1 - 0.5 * u)}
    whisker = beam(radius=0.003, tip_radius=0.0003 + 0.001 * u, natural_curvature=-0.4 * u)
    kinds: dict[str, dict[str, Any]] = {
        "plain": {"beam": beam(radius=0.01 * u)},
        "in-units": {"beam": beam(0.02 + 0.08 * u, 1e-6 + 1e-3 * u**2, radius=2e-4)},
        "friction": friction,
        "soft": soft,
        "curved": curved,
        "towards": {"beam": beam(natural_curvature=0.05 + 0.4 * u)},
        "taper": {"beam": beam(tip_radius=0.001 + 0.003 * u)},
        "graded": {"beam": beam(flexural_rigidity=[(0, 1), (0.5, 0.5 + 0.4 * u), (1, 0.3)])},
        "bowed": {"beam": beam(natural_curvature=lambda s: -(0.2 + 0.6 * u) * s)},
        "mixed": {**friction, **soft, **curved},
        "whisker": {**friction, **soft, "beam": whisker},
    }
    return kinds[kind]


def mesh(kind: str, draw: Draw, turn: Any) -> trimesh.Trimesh:
    """About the origin."""
    size = float(draw.uniform(0.5, 0.9))
    made: trimesh.Trimesh = {
        "ball": trimesh.creation.icosphere(2, size),
        "box": trimesh.creation.box(extents=size * draw.uniform(0.8, 1.6, 3)),
        "capsule": trimesh.creation.capsule(height=size, radius=0.4 * size, count=[16, 16]),
        "hull": trimesh.convex.convex_hull(size * directions(30, draw)),
    }[kind]
    made.apply_translation(-made.centroid)
    made.vertices = made.vertices @ turn
    return made


def directions(count: int, draw: Draw) -> Any:
    points = draw.normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def rotation(draw: Draw) -> Any:
    turn, _ = np.linalg.qr(draw.normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


def body(kind: str, draw: Draw) -> space.Body:
    """Its lowest point is 0.3 to 0.6 L above the plane of the foot."""
    low, r = draw.uniform(0.3, 0.6), draw.uniform(0.4, 1.0)
    if kind in MESHES:
        made = mesh(kind, draw, rotation(draw))
        made.export("body.stl")
        return space.convex_mesh("body.stl", offset=(0.0, low - made.bounds[0][1], 0.0))
    axes, frame, points = draw.uniform(0.4, 1.0, 3), rotation(draw), r * directions(20, draw)
    axis = (draw.uniform(-0.3, 0.3), draw.uniform(-0.2, 0.2), 1.0)
    height = low + float(np.sqrt(((axes * frame[:, 1]) ** 2).sum()))  # of a turned ellipsoid
    up = np.array([0.0, 1.0, 0.0])
    return {
        "sphere": space.sphere(r, up * (low + r)),
        "ellipsoid": space.ellipsoid(tuple(axes), up * height, frame),
        "cylinder": space.cylinder(r / 2, up * (low + r / 2), axis),
        "prism": space.prism(contour("catenary", draw), axis),
        "polyhedron": space.polyhedron(points + up * (low - points[:, 1].min())),
        "smooth": space.SmoothBody(
            lambda n: up * (low + axes[1]) + axes**2 * n / np.linalg.norm(axes * n)
        ),
    }[kind]


def spatial(kind: str, stations: int, draw: Draw) -> space.SpatialCase:
    """A straight way past a drawn body, oblique, of a clamp that leans."""
    angle, aside = draw.uniform(-0.5, 0.5), draw.uniform(-0.15, 0.15)
    along, across = np.array([[-np.cos(angle), np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    far = 2.0 if kind == "prism" else 1.25
    way, lean = [aside * across + t * along for t in (-far, far)], draw.uniform(-0.2, 0.2, 2)
    path = space.FootPath(way, tangent=(lean[0], 1.0, lean[1]), stations=stations)
    return space.SpatialCase(body=body(kind, draw), path=path)
