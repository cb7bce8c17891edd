"""Three bodies in files, and oblique ways past them at random."""

from pathlib import Path

import numpy as np
import trimesh

from analytic import InputError
from analytic.space import SpatialCase, convex_mesh
from tests.fuzz import space

FILES = ("ball.stl", "ellipsoid.obj", "capsule.ply")
_LOWEST = 0.4  # L above the way of the foot


def body(file: str) -> trimesh.Trimesh:
    """The body of that name, as long and as wide as vibrissae reach."""
    if file == "capsule.ply":
        mesh = trimesh.creation.capsule(height=0.8, radius=0.4, count=[16, 16])
        mesh.apply_transform(trimesh.transformations.rotation_matrix(0.3, (1, 0.5, 0)))
    else:
        mesh = trimesh.creation.icosphere(3)
        mesh.apply_scale((1, 1, 1) if file == "ball.stl" else (1, 0.7, 1.6))
    mesh.apply_translation((0, _LOWEST, 0) - mesh.bounds.mean(axis=0) + mesh.extents * (0, 0.5, 0))
    return mesh


def oblique(file: str, seed: int, folder: Path, stations: int = 60) -> SpatialCase:
    """A way under it in any direction, beside its middle, with the clamp leaning to any side."""
    draw, mesh = np.random.default_rng(seed), body(file)
    mesh.export(folder / file)
    solid, wide = convex_mesh(folder / file), float(mesh.extents[[0, 2]].max()) / 2
    while True:
        path = space.oblique(draw, wide, stations)
        try:
            return SpatialCase(body=solid, path=path, name=f"{file} {seed}")
        except InputError:  # out of reach
            continue
