"""A sweep in space as it is drawn: the body, the vibrissa, its foot and its contacts."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from analytic.numerics.arrays import Floats, Integers, Words
from analytic.problem.files import SOFTWARE
from analytic.space import Body, SpatialReadings, deflected_rods, reconstruct_space
from analytic.space.problem.bodies.support import spread
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE

_DEPTH = 0.5  # of the scene, at least, over its longest side
_MARGIN = 0.1  # L, around what moves
_CORNERS = 500  # of a body that is drawn: what a picture can show of a round one
_SLIVER = 1e-6  # L; a body that shows less is not drawn


@dataclass(frozen=True, eq=False)
class SweepScene:
    """What pictures of a sweep show; lengths in L, y up."""

    readings: SpatialReadings  # the sweep
    # Shape (stations, points, 3); from clamp to tip, NaN where there are no readings.
    lines: Floats
    foot: Floats  # shape (stations, 3)
    contact: Floats  # shape (stations, 3); as found from the clamp, NaN where there is none
    phase: Words  # shape (stations,); as recorded, else as found from the clamp
    # Shape (triangles, 3, 3); of the part of the body that is near, corners against the clock as
    # seen from outside; none without a body.
    faces: Floats
    low: Floats  # shape (3,); corners of the box around all of it
    high: Floats  # shape (3,)

    @classmethod
    def of(cls, readings: SpatialReadings, body: Body | Floats | None) -> "SweepScene":
        length, table = readings.beam.length, readings.table
        found = reconstruct_space(readings)
        phase = table["phase"] if "phase" in table else found["phase"]
        if "contact_arc_length" not in table:
            arc = found["contact_arc_length"].to_numpy()
            readings = replace(readings, table=table.assign(contact_arc_length=arc))
        # What is free but for noise is drawn straight.
        none = readings.trusted & found["torsion"].isna().to_numpy()
        loads = {name: np.where(none, 0.0, readings.values(name)) for name in FORCE}
        shown = replace(readings, table=readings.table.assign(**loads))
        lines, foot = deflected_rods(shown) / length, readings.values(*FOOT) / length
        low, high = _box(np.concatenate([lines[np.isfinite(lines).all(axis=2)], foot]))
        faces = np.empty((0, 3, 3))
        if isinstance(body, np.ndarray):
            faces = body / length
        elif body is not None:
            middle, reach = (low + high) / 2, 0.6 * float((high - low).max())
            patches = body.scaled(1 / length).patches(middle, reach)
            faces = faces_within(patches.reshape(-1, 3), low, high)
        contact = found[list(CONTACT_POINT)].to_numpy(dtype=float) / length
        return cls(readings, lines, foot, contact, phase.to_numpy(dtype=str), faces, low, high)


def _box(points: Floats) -> tuple[Floats, Floats]:
    low, high = points.min(axis=0), points.max(axis=0)
    deep = _DEPTH / 2 * np.array([1.0, 0.0, 1.0]) * (high - low).max()  # a straight way has none
    middle = (low + high) / 2
    return np.minimum(low, middle - deep) - _MARGIN, np.maximum(high, middle + deep) + _MARGIN


def faces_within(points: Floats, low: Floats, high: Floats) -> Floats:
    """The surface of what a convex body and a box have in common."""
    try:
        hull = ConvexHull(_outermost(points))
        # A point within both, as far as can be from all planes: n.x + d + |n| r <= 0.
        box = np.block([[np.eye(3), -high[:, None]], [-np.eye(3), low[:, None]]])
        planes = np.concatenate([hull.equations, box])
        upper = np.column_stack([planes[:, :3], np.ones(len(planes))])
        found = linprog([0, 0, 0, -1], upper, -planes[:, 3], bounds=[(None, None)] * 3 + [(0, 9)])
        inner = found.x
        if inner is None or inner[3] < _SLIVER:
            return np.empty((0, 3, 3))
        cut = HalfspaceIntersection(planes, inner[:3]).intersections
        surface = ConvexHull(cut[np.isfinite(cut).all(axis=1)])
    except QhullError:  # of a flat or tiny part there is nothing to see
        return np.empty((0, 3, 3))
    corners = surface.points[surface.simplices]
    inward = (normals(corners) * surface.equations[:, :3]).sum(axis=1) < 0
    corners[inward] = corners[inward][:, ::-1]
    return np.asarray(corners)


def normals(faces: Floats) -> Floats:
    """Unit vectors out of triangles whose corners run against the clock."""
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 1])
    sizes = np.linalg.norm(across, axis=1, keepdims=True)
    return np.asarray(across / np.maximum(sizes, 1e-300))


def _outermost(points: Floats) -> Floats:
    """The points themselves if they are few, else those that reach farthest in many directions."""
    points = pd.DataFrame(points).drop_duplicates().to_numpy()
    if len(points) <= _CORNERS:
        return points
    chosen = [np.argmax(points @ way) for way in spread(_CORNERS)]
    return np.asarray(points[np.unique(chosen)])


def corners_and_faces(faces: Floats) -> tuple[Floats, Integers]:
    """Each corner of triangles once, and which three of them each triangle has."""
    corners, where = np.unique(faces.reshape(-1, 3), axis=0, return_inverse=True)
    return corners, where.reshape(-1, 3)


def solid_ply(faces: Floats) -> str:
    """Triangles as PLY, with all their digits."""
    corners, where = corners_and_faces(faces)
    header = [
        "ply",
        "format ascii 1.0",
        f"comment {SOFTWARE}",
        f"element vertex {len(corners)}",
        *(f"property double {name}" for name in "xyz"),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    points = [" ".join(f"{value:.17g}" for value in corner) for corner in corners]
    triangles = ["3 " + " ".join(map(str, face)) for face in where.tolist()]
    return "\n".join([*header, *points, *triangles, ""])
