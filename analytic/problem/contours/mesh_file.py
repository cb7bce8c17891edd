"""A convex body from a mesh file: read, merged, checked, and made no finer than it need be."""

from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from analytic.problem.arrays import Floats, Integers
from analytic.problem.contours.simplify import thinned
from analytic.problem.errors import InputError
from analytic.problem.files import as_path, regular_file

SUFFIXES = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
_ASCII = bytes(range(128)) + 128 * b"?"
_LARGEST = 256_000_000  # bytes; an STL file of 5 million faces
_ROUNDING = 1e-5  # of the volume: files hold single precision
_ONE_PLACE = 1e-8  # of the extent: vertices that are as near are one
_FLAT = 1e-7  # of the extent: likewise
# Odd numbers without a pattern, to scatter what is multiplied by them.
_HASH = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)
_MOST_VERTICES = 50_000  # the hull of a round body takes MuJoCo half a second then


class MeshBody(NamedTuple):
    """A convex body in a file's own unit and axes."""

    vertices: Floats
    """Shape (n, 3)."""
    faces: Integers
    """Triangles of vertices, shape (m, 3)."""
    normals: Floats
    """Outward unit normals, shape (m, 3); exactly alike on triangles of one plane."""
    neighbours: Integers
    """The triangle across the edge that faces each vertex of a triangle, shape (m, 3)."""
    miss: float = 0.0
    """How far vertices of the file that were left out lie outside."""


class _Read(NamedTuple):
    vertices: Floats
    """In units of `size`, about `middle`; those at one place are one."""
    faces: Integers
    middle: Floats
    size: float

    def sides(self) -> Integers:
        """A number for each side of each triangle, ascending.

        Half of it, rounded down, is that of the edge; even and odd are its two directions.
        """
        begins, ends = self.faces.ravel(), np.roll(self.faces, -1, axis=1).ravel()
        edges = np.minimum(begins, ends) * len(self.vertices) + np.maximum(begins, ends)
        return np.sort(2 * edges + (begins < ends))


def read_body(file: str | Path, hull: bool, tolerance: float) -> MeshBody:
    """The convex body in a mesh file.

    Vertices at one place are merged whatever their texture or normals, inside-out meshes are turned
    and vertices inside the hull are dropped. A body of more than 50,000 vertices is thinned to that
    number at most.
    """
    from scipy.spatial import QhullError  # slow to load, as trimesh is

    file = as_path(file, "mesh file")
    read = _load(file)
    size, sides = read.size, read.sides()
    if not hull and not _is_closed(sides):
        raise InputError(
            f"mesh {file}",
            _fault(read, sides),
            "watertight",
            "fix it, or take its hull (hull = true)",
        )
    try:
        kept, miss = thinned(read.vertices, tolerance / size, _MOST_VERTICES)
        body, volume = _hull(kept)
    except QhullError as error:
        raise InputError(f"mesh {file}", "flat", "a solid", "check it") from error
    if 0 < tolerance < miss * size:
        raise InputError(
            "mesh tolerance",
            tolerance,
            f"{miss * size:.3g} or more",
            f"{file} has too many vertices",
        )
    if not hull:
        _check_convex(read, sides, volume, file)
    return body._replace(vertices=read.middle + size * body.vertices, miss=miss * size)


def _is_closed(sides: Integers) -> bool:
    """Whether each edge has two faces."""
    edges = sides // 2
    if len(edges) % 2:
        return False
    paired = (edges[::2] == edges[1::2]).all()
    return bool(paired and (edges[1:-1:2] != edges[2::2]).all())


def _fault(read: _Read, sides: Integers) -> str:
    """What is wrong with a mesh that is not closed, and where: a rim rather than a ridge."""
    edges, counts = np.unique(sides // 2, return_counts=True)
    worst = np.flatnonzero(counts != 2)
    one = worst[np.argmin(counts[worst])]
    ends = read.vertices[list(divmod(int(edges[one]), len(read.vertices)))]
    x, y, z = read.middle + read.size * ends.mean(axis=0)
    what = "open" if counts[one] == 1 else f"with {counts[one]} faces on one edge"
    return f"{what} at ({x:.4g}, {y:.4g}, {z:.4g})"


def _check_convex(read: _Read, sides: Integers, hull: float, file: Path) -> None:
    """Refuse a closed mesh that fills less than the volume of its hull."""
    corners = (read.vertices - read.vertices.mean(axis=0))[read.faces]
    cones = np.einsum("nd,nd->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    if not (sides.reshape(-1, 2) % 2 == [0, 1]).all():
        cones = np.abs(cones)  # whichever way the faces look
    volume = abs(float(cones.sum()))
    if volume < (1 - _ROUNDING) * hull:
        import trimesh

        mesh = trimesh.Trimesh(read.vertices, read.faces, process=False)
        dent = int(np.argmax(mesh.face_adjacency_projections * np.sign(mesh.volume)))
        x, y, z = read.middle + read.size * read.vertices[mesh.face_adjacency_edges[dent, 0]]
        raise InputError(
            f"mesh {file}",
            f"filling {volume / hull:.2%} of its convex hull, dented at "
            f"({x:.4g}, {y:.4g}, {z:.4g})",
            "convex",
            "take the hull (hull = true) or one convex part",
        )


def _load(file: Path) -> _Read:
    if file.suffix.lower() not in SUFFIXES:
        raise InputError(
            "mesh file", file, f"named {', '.join(f'*{s}' for s in SUFFIXES)}", "convert it"
        )
    regular_file(file, "mesh file", _LARGEST)
    import trimesh
    from trimesh.exchange.stl import load_stl

    kind = file.suffix.lower().removeprefix(".")
    options = {"skip_materials": True} if kind == "obj" else {}
    try:
        with np.errstate(all="ignore"):
            if kind == "stl":
                points, faces = _triangles(load_stl(_in_ascii(file.read_bytes(), kind)))
            else:
                # A glTF may name files beside it.
                source = file if kind in ("glb", "gltf") else _in_ascii(file.read_bytes(), kind)
                found = trimesh.load_mesh(source, file_type=kind, process=False, **options)
                points = np.asarray(found.vertices, dtype=float).reshape(-1, 3)
                faces = np.asarray(found.faces).reshape(-1, 3)
            points, faces = _merged(points, faces, points)
            size = float(np.ptp(points, axis=0).max()) if len(faces) else 0.0
    except ImportError as error:  # of what trimesh needs for some files only
        package = error.name or str(error)
        raise InputError(
            "mesh file",
            file,
            f"readable without the Python package {package}",
            f"pip install {package}, or save it as a binary STL",
        ) from error
    except Exception as error:  # a parser of foreign bytes may raise anything
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(
            "mesh file", file, "a readable STL, OBJ, PLY, OFF, GLB or glTF", f"check it ({reason})"
        ) from error
    if len(faces) < 4 or not np.isfinite(size):
        raise InputError(
            f"mesh {file}", f"of {len(faces)} faces", "a solid of finite vertices", "check it"
        )
    if not 1e-90 < size < 1e90:
        raise InputError(
            f"mesh {file}", f"of size {size:.3g}", "between 1e-90 and 1e90", "change its unit"
        )
    middle = np.bincount(faces.ravel()) @ points / faces.size
    vertices = (points - middle) / size
    # What is as near as rounding is at one place too.
    vertices, faces = _merged(vertices, faces, np.rint(vertices / _ONE_PLACE))
    one, two, three = faces.T  # slivers close it
    faces = faces[(one != two) & (two != three) & (three != one)]
    if len(faces) < 4:  # a vertex far away makes all others one
        raise InputError(
            f"mesh {file}",
            f"of size {size:.3g} with {len(faces)} faces that are not next to nothing",
            "a solid of four or more",
            "check its vertices",
        )
    return _Read(vertices, faces, middle, size)


def _triangles(found: dict[str, Any]) -> tuple[Floats, Integers]:
    """Of an STL file's solids, without the copies that a scene makes of them."""
    solids = found.get("geometry", {"": found}).values()
    points = np.concatenate([np.zeros((0, 3)), *(solid["vertices"] for solid in solids)])
    return points, np.arange(len(points)).reshape(-1, 3)


def _merged(points: Floats, faces: Integers, places: Floats) -> tuple[Floats, Integers]:
    """Points of faces, those at one place once: an STL file repeats every vertex.

    Without sorting them: by one number for each, whose places are then compared.
    """
    bits = np.ascontiguousarray(places + 0.0).view(np.uint64)  # + 0.0 turns -0.0 into 0.0
    bits ^= bits >> np.uint64(29)  # numbers of single precision end with so many zeros
    import pandas as pd  # slow to load, and few cases have a mesh

    codes, numbers = pd.factorize((bits * _HASH).sum(axis=1))
    first = np.empty(len(numbers), dtype=np.intp)
    first[codes[::-1]] = np.arange(len(points))[::-1]
    if not np.array_equal(places[first][codes], places):  # two places with one number
        first, codes = np.unique(places, axis=0, return_index=True, return_inverse=True)[1:]
    faces = codes.ravel()[faces]
    used = np.zeros(len(first), dtype=bool)
    used[faces] = True
    return points[first[used]], (np.cumsum(used) - 1)[faces]


def _in_ascii(content: bytes, kind: str) -> BytesIO:
    """A mesh without the letters of its comments and names, whose encoding nobody states."""
    text = len(content)
    if kind == "ply":
        text = content.find(b"end_header") + 1
    elif kind == "stl" and content.find(b"\0", 84) >= 0:  # a binary one has no text but its header
        text = 80
    return BytesIO(content[:text].translate(_ASCII) + content[text:])


def _hull(points: Floats) -> tuple[MeshBody, float]:
    """The convex hull of points, and its volume."""
    from scipy.spatial import ConvexHull, QhullError

    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[-1] < _FLAT * spread[0]:
        raise QhullError
    found = ConvexHull(points)
    body = MeshBody(
        points[found.vertices],
        np.searchsorted(found.vertices, found.simplices),
        found.equations[:, :3],
        found.neighbors,
    )
    return body, float(found.volume)
