"""The part of a body that a sweep's pictures show, as a file that mesh viewers read."""

import numpy as np

from analytic.problem.arrays import Floats


def solid_ply(faces: Floats) -> str:
    """Triangles as PLY, with all their digits."""
    corners, where = np.unique(faces.reshape(-1, 3), axis=0, return_inverse=True)
    header = [
        "ply",
        "format ascii 1.0",
        f"element vertex {len(corners)}",
        *(f"property double {name}" for name in "xyz"),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    points = [" ".join(f"{value:.17g}" for value in corner) for corner in corners]
    triangles = ["3 " + " ".join(map(str, face)) for face in where.reshape(-1, 3).tolist()]
    return "\n".join([*header, *points, *triangles, ""])
