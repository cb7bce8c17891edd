"""The section of a convex mesh file by the plane of the sweep."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.contours.polygon import Polygon, polygon
from analytic.problem.contours.solid import ConvexMesh
from analytic.problem.errors import InputError

if TYPE_CHECKING:
    from trimesh import Trimesh

_ROUNDING = 1e-5  # of the volume: files hold single precision
_IN_PLANE = 1e-6  # of the mesh's extent: likewise


def mesh_section(
    file: str | Path,
    scale: float = 1.0,
    offset: tuple[float, float] = (0.0, 0.0),
    height: float = 0.0,
    axes: str = "xy",
) -> Polygon:
    """The polygon in which the plane of the sweep cuts a convex mesh.

    It knows the mesh that it is cut from (``solid``), and how far the mesh's normals leave the
    plane there (``solid.tilt``): a bead of radius r touches a face that is tilted by t at the
    distance r/cos(t) from the section, and is pushed out of the plane.

    Parameters
    ----------
    file : path
        STL, OBJ or PLY.
    scale : float
        From the file's unit of length to the case's.
    offset : tuple of float
        Where the file's origin goes, after scaling [length].
    height : float
        Of the plane along the third axis, in the file's unit.
    axes : str
        The mesh's axes that become x and y of the sweep: ``"xy"``, ``"xz"``, ``"zy"``, ...

    Raises
    ------
    InputError
        If the file cannot be read, its mesh is open or not convex, or the plane misses it.
    """
    from scipy.spatial import ConvexHull  # slow to load, as trimesh is
    from trimesh.intersections import mesh_plane

    if sorted(axes) not in ([*"xy"], [*"xz"], [*"yz"]):
        raise InputError("mesh axes", repr(axes), "two of x, y and z", "'xy' is usual")
    mesh = _load(Path(file))
    third = ({"x", "y", "z"} - set(axes)).pop()
    across = ["xyz".index(axis) for axis in (*axes, third)]
    normal, origin = np.zeros(3), np.zeros(3)
    normal[across[2]], origin[across[2]] = 1.0, height
    low, high = mesh.bounds[:, across[2]]
    if not low < height < high:
        raise InputError(
            f"height {height:g} of the plane through {file}",
            f"outside {low:.6g}..{high:.6g} along {third}",
            f"where the mesh is, between its ends along {third}",
            "move the plane",
        )
    cut: Floats = mesh_plane(mesh, normal, origin)  # type: ignore[no-untyped-call]
    section = cut.reshape(-1, 3)[:, across[:2]]
    hull = section[ConvexHull(section).vertices]
    outline = polygon(hull * scale + np.asarray(offset), f"section of {Path(file).name}")
    placed = (mesh.vertices - origin)[:, across] * [1, 1, _handedness(across)]
    solid = ConvexMesh(placed * scale + [*offset, 0], _tilt(mesh, across, height), Path(file).name)
    return replace(outline, solid=solid)


def _handedness(across: list[int]) -> int:
    """1 if these axes are right-handed, -1 if not: the body must not become its mirror image."""
    return round(float(np.linalg.det(np.eye(3)[across])))


def _tilt(mesh: "Trimesh", across: list[int], height: float) -> float:
    """Largest component of the normals across the plane, along the lower side of the section.

    An edge in the plane has all normals between those of its two faces; the least tilted counts.
    """
    _, up, third = across
    above = mesh.vertices[:, third] - height
    above[np.abs(above) < _IN_PLANE * mesh.scale] = 0
    sides = above[mesh.faces]
    normals = mesh.face_normals
    cut = (sides.min(axis=1) < 0) & (sides.max(axis=1) > 0) & (normals[:, up] < 0)
    rim = normals[mesh.face_adjacency[(above[mesh.face_adjacency_edges] == 0).all(axis=1)]]
    rim = rim[rim[:, :, up].sum(axis=1) < 0][:, :, third]
    one_way = rim.prod(axis=1) > 0
    tilts = [*np.abs(normals[cut, third]), *np.abs(rim[one_way]).min(axis=1)]
    return float(max(tilts, default=0.0))


def _load(file: Path) -> "Trimesh":
    import trimesh
    from scipy.spatial import ConvexHull

    try:
        mesh: Trimesh = trimesh.load_mesh(file)
    except (OSError, ValueError, KeyError, IndexError, TypeError, NotImplementedError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(
            "mesh file", file, "a readable STL, OBJ or PLY", f"check it ({reason})"
        ) from error
    if len(mesh.faces) < 4 or not np.isfinite(mesh.vertices).all():
        raise InputError(
            f"mesh {file}", f"{len(mesh.faces)} faces", "a solid of finite vertices", "check it"
        )
    if not mesh.is_watertight:
        raise InputError(f"mesh {file}", "open", "watertight", "close its holes, or merge vertices")
    filled = mesh.volume / ConvexHull(mesh.vertices).volume
    if filled < 1 - _ROUNDING:
        dent = int(np.argmax(mesh.face_adjacency_projections))
        x, y, z = mesh.vertices[mesh.face_adjacency_edges[dent, 0]]
        raise InputError(
            f"mesh {file}",
            f"filling {filled:.2%} of its convex hull, dented at ({x:.4g}, {y:.4g}, {z:.4g})",
            "convex",
            "take the hull or one convex part",
        )
    return mesh
