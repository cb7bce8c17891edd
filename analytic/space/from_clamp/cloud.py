"""A surface scanned by sweeps: a cloud of points with normals, in a file and against the body."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError, require
from analytic.problem.files import SOFTWARE, as_path, write_whole
from analytic.problem.numbers import positive
from analytic.space.problem.bodies.body import Body
from analytic.space.problem.readings import CONTACT_POINT, NORMAL

_AS_FOUND = "as reconstruct_space gives it"
_FARTHEST = 100.0  # of the length
_APART = 0.25  # of the length: how far off the surface its nearest point is asked for


class Cloud(NamedTuple):
    """Points of a surface with outward normals."""

    points: Floats
    """Shape (n, 3) [length]."""
    normals: Floats
    """Of length 1, shape (n, 3)."""


class Misses(NamedTuple):
    """How far a cloud is from a body."""

    distances: Floats
    """Of the points from the surface, shape (n,) [length]."""
    angles: Floats
    """Between the normals and those of the surface there, shape (n,) [rad]."""


def point_cloud(*found: pd.DataFrame) -> Cloud:
    """The contacts of one or several sweeps.

    Parameters
    ----------
    *found : pandas.DataFrame
        Each from `reconstruct_space`.

    Returns
    -------
    Cloud
        Of the stations that touch.

    Raises
    ------
    InputError
        If no station touches.
    """
    parts = [require("found", one, pd.DataFrame, _AS_FOUND) for one in found]
    if not all({*CONTACT_POINT, *NORMAL} <= {*one} for one in parts):
        raise InputError("found", "without contacts and normals", "of a sweep in space", _AS_FOUND)
    rows = [one[[*CONTACT_POINT, *NORMAL]].dropna().to_numpy(dtype=float) for one in parts]
    table = np.concatenate([np.empty((0, 6)), *rows])
    if not len(table):
        raise InputError("readings", "without a contact", "with one at a station", "check them")
    return Cloud(table[:, :3], table[:, 3:])


def write_ply(cloud: Cloud, path: str | Path) -> Path:
    """Write a cloud as PLY, as every mesh viewer reads it.

    Parameters
    ----------
    cloud : Cloud
        Points and normals.
    path : str or Path
        Named ``*.ply``.

    Returns
    -------
    Path
        `path`.

    Raises
    ------
    InputError
        If it is named otherwise.
    OSError
        If the file cannot be written.
    """
    require("cloud", cloud, Cloud, "as point_cloud(reconstruct_space(readings))")
    path = as_path(path, "point cloud")
    if path.suffix.lower() != ".ply":
        raise InputError("point cloud", path, "named *.ply", "rename it")
    names = ("x", "y", "z", "nx", "ny", "nz")
    header = [
        "ply",
        "format ascii 1.0",
        f"comment {SOFTWARE}",
        f"element vertex {len(cloud.points)}",
        *(f"property double {name}" for name in names),
        "end_header",
    ]
    rows = np.hstack([cloud.points, cloud.normals])
    lines = [" ".join(f"{value:.17g}" for value in row) for row in rows]
    return write_whole(path, "\n".join([*header, *lines, ""]))


def misses(cloud: Cloud, body: Body, length: float) -> Misses:
    """How far a cloud is from the true body.

    Parameters
    ----------
    cloud : Cloud
        Points and normals.
    body : Body
        The true one, in the same unit.
    length : float
        Of the vibrissa [length]: a scale to look at the surface from.

    Returns
    -------
    Misses
        Distances and angles.
    """
    require("cloud", cloud, Cloud, "as point_cloud(reconstruct_space(readings))")
    require("body", body, Body, "as sphere(1.0, centre=(0, 1.4, 0))")
    length = positive("length", length)
    distances, angles = [], []
    for point, normal in zip(cloud.points, cloud.normals, strict=True):
        apart = _APART * length
        spot = body.nearest(point + apart * normal, apart)
        while spot.distance <= 0 and apart < _FARTHEST * length:  # of a point deep inside
            apart *= 2
            spot = body.nearest(point + apart * normal, apart)
        between = float(np.linalg.norm(spot.normal - normal))
        outside = spot.distance > 0
        distances.append(abs(float((point - spot.point) @ spot.normal)) if outside else np.inf)
        angles.append(2 * np.arcsin(min(between / 2, 1.0)))
    return Misses(np.array(distances), np.array(angles))
