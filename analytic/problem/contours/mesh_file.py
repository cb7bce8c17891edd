"""A convex body from a mesh file: read, merged, checked, and made no finer than it need be."""

from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.errors import InputError, require
from analytic.problem.files import as_path, regular_file

_START = 4  # cells along an edge of the cube
_SAMPLE, _EACH = 50_000, 8  # points that are asked at least, and for each that is kept
_ROUNDS = 20  # the number of points about doubles in each
_NEAREST = 6  # faces that are asked whether a vertex lies outside of them
_ON_SURFACE = 1e-12  # of the body's size; as far outside is on the surface

SUFFIXES = (".stl", ".obj", ".ply", ".off", ".glb", ".gltf")
_ASCII = bytes(range(128)) + 128 * b"?"
_LARGEST = 256_000_000  # bytes; an STL file of 5 million faces
_ROUNDING = 1e-5  # of the volume: files hold single precision
_ONE_PLACE = 1e-8  # of the extent: vertices that are as near are one
_FLAT = 1e-7  # of the extent: likewise
_MOST_VERTICES = 50_000  # the hull of a round body takes MuJoCo half a second then


def thinned(points: Floats, tolerance: float, most: int) -> tuple[Floats, float]:
    """Points of a convex surface such that their hull is nearly that of all."""
    if tolerance == 0 and len(points) <= most:
        return points, 0.0
    allowed = max(tolerance, _ON_SURFACE * float(np.ptp(points, axis=0).max()))
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


class MeshBody(NamedTuple):
    """A convex body in a file's own unit and axes."""

    vertices: Floats  # shape (n, 3)
    faces: Integers  # triangles of vertices, shape (m, 3)
    normals: Floats  # outward unit normals, shape (m, 3); exactly alike on triangles of one plane
    # the triangle across the edge that faces each vertex of a triangle, shape (m, 3).
    neighbours: Integers
    miss: float = 0.0  # how far vertices of the file that were left out lie outside


class _Read(NamedTuple):
    vertices: Floats  # in units of `size`, about `middle`; those at one place are one
    faces: Integers
    middle: Floats
    size: float

    def shown(self, place: Floats) -> str:
        x, y, z = self.middle + self.size * place
        return f"({x:.4g}, {y:.4g}, {z:.4g})"


def read_body(file: str | Path, hull: bool, tolerance: float) -> MeshBody:
    """The convex body in a mesh file: merged, turned outside in if need be, thinned if too fine."""
    from scipy.spatial import QhullError  # slow to load, as trimesh is

    file = as_path(file, "mesh file")
    require("mesh hull", hull, bool, "True takes the hull of an open or dented mesh")
    read = _load(file)
    size = read.size
    if not hull:
        _check_closed(read, file)
    try:
        kept, miss = thinned(read.vertices, tolerance / size, _MOST_VERTICES)
        spread = np.linalg.svd(kept - kept.mean(axis=0), compute_uv=False)
        if spread[-1] < _FLAT * spread[0]:
            raise QhullError
        body, volume = hull_of(kept)
    except QhullError as error:
        raise InputError(f"mesh {file}", "flat", "a solid", "check it") from error
    if 0 < tolerance < miss * size:
        remedy = f"{file} has too many vertices"
        raise InputError("mesh tolerance", tolerance, f"{miss * size:.3g} or more", remedy)
    if not hull:
        _check_convex(read, volume, file)
    return body._replace(vertices=read.middle + size * body.vertices, miss=miss * size)


def _check_closed(read: _Read, file: Path) -> None:
    """Refuse a mesh with an edge that has not two faces; a rim is named rather than a ridge."""
    count = len(read.vertices)
    ends = np.sort(read.faces[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    edges, counts = np.unique(ends[..., 0] * count + ends[..., 1], return_counts=True)
    worst = np.flatnonzero(counts != 2)
    if worst.size:
        one = worst[np.argmin(counts[worst])]
        what = "open" if counts[one] == 1 else f"with {counts[one]} faces on one edge"
        middle = read.vertices[[*divmod(int(edges[one]), count)]].mean(axis=0)
        remedy = "fix it, or take its hull (hull = true)"
        raise InputError(f"mesh {file}", f"{what} at {read.shown(middle)}", "watertight", remedy)


def _check_convex(read: _Read, hull: float, file: Path) -> None:
    import trimesh

    mesh = trimesh.Trimesh(read.vertices, read.faces, process=False)
    volume = abs(float(mesh.volume))
    if not mesh.is_winding_consistent:  # whichever way the faces look
        corners = (read.vertices - read.vertices.mean(axis=0))[read.faces]
        volume = float(np.abs(np.linalg.det(corners)).sum()) / 6
    if volume < (1 - _ROUNDING) * hull:
        dent = int(np.argmax(mesh.face_adjacency_projections * np.sign(mesh.volume)))
        place = read.shown(read.vertices[mesh.face_adjacency_edges[dent, 0]])
        what = f"filling {volume / hull:.2%} of its convex hull, dented at {place}"
        remedy = "take the hull (hull = true) or one convex part"
        raise InputError(f"mesh {file}", what, "convex", remedy)


def _load(file: Path) -> _Read:
    if file.suffix.lower() not in SUFFIXES:
        allowed = f"named {', '.join(f'*{s}' for s in SUFFIXES)}"
        raise InputError("mesh file", file, allowed, "convert it")
    regular_file(file, "mesh file", _LARGEST)
    import trimesh

    kind = file.suffix.lower().removeprefix(".")
    options = {"skip_materials": True} if kind in ("obj", "ply") else {}
    try:
        # A glTF may name files beside it.
        source = file if kind in ("glb", "gltf") else _in_ascii(file.read_bytes(), kind)
        with np.errstate(all="ignore"):
            found = trimesh.load_mesh(source, file_type=kind, process=False, **options)
            points = np.asarray(found.vertices, dtype=float).reshape(-1, 3)
            corners = points[np.asarray(found.faces).ravel()]
            size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    except ImportError as error:  # of what trimesh needs for some files only
        package = error.name or str(error)
        allowed = f"readable without the Python package {package}"
        remedy = f"pip install {package}, or save it as a binary STL"
        raise InputError("mesh file", file, allowed, remedy) from error
    except Exception as error:  # a parser of foreign bytes may raise anything
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        allowed = "a readable STL, OBJ, PLY, OFF, GLB or glTF"
        raise InputError("mesh file", file, allowed, f"check it ({reason})") from error
    if not len(corners):
        remedy = f"check that its content is that of *.{kind}"
        raise InputError(f"mesh {file}", "without a triangle", "a solid", remedy)
    if not 1e-90 < size < 1e90:
        what, allowed = f"of size {size:.3g}", "a solid of a size between 1e-90 and 1e90"
        raise InputError(f"mesh {file}", what, allowed, "check its vertices and its unit")
    middle = corners.mean(axis=0)
    vertices, faces = _merged((corners - middle) / size)
    if len(faces) < 4:
        what = f"{len(faces)} triangles with an area, in a size of {size:.3g}"
        remedy = "check its vertices: one far away makes all others one"
        raise InputError(f"mesh {file}", what, "four or more, of a solid", remedy)
    return _Read(vertices, faces, middle, size)


def _merged(corners: Floats) -> tuple[Floats, Integers]:
    """Vertices and faces of triangles' corners, those at one place once; without slivers."""
    import pandas as pd  # slow to load, and few cases have a mesh

    places = pd.DataFrame(np.rint(corners / _ONE_PLACE))
    codes = places.groupby([0, 1, 2], sort=False).ngroup().to_numpy()
    first = np.flatnonzero(~places.duplicated())
    one, two, three = faces = codes.reshape(-1, 3).T
    return corners[first], faces[:, (one != two) & (two != three) & (three != one)].T


def _in_ascii(content: bytes, kind: str) -> BytesIO:
    """A mesh without the letters of its comments and names, whose encoding nobody states."""
    text = len(content)
    if kind == "ply":
        text = content.find(b"end_header") + 1
    elif kind == "stl" and content.find(b"\0", 84) >= 0:  # a binary one has no text but its header
        text = 80
    return BytesIO(content[:text].translate(_ASCII) + content[text:])


def hull_of(points: Floats) -> tuple[MeshBody, float]:
    from scipy.spatial import ConvexHull

    found = ConvexHull(points)
    body = MeshBody(
        points[found.vertices],
        np.searchsorted(found.vertices, found.simplices),
        found.equations[:, :3],
        found.neighbors,
    )
    return body, float(found.volume)
