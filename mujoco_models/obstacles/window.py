"""The mesh of a prism, written into a compiled model.

MuJoCo's compiler looks for the hull of every mesh that collides, which takes longer than a sweep
where there are many. The hull of a prism is known. So the compiler is given a mesh of as many
vertices, in a sphere, which needs as much room as any hull of so many, and what it found is
replaced by the prism's.
"""

from functools import cache

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.obstacles.protocol import add_collider

# L, of the extrusion: more than the vibrissa's length, so that it cannot leave over the prism's
# ends, and much more than a penetration, or depths come out wrong.
HALF_DEPTH = 1.5
_LEAST = 12  # vertices: with fewer, a hull of triangles would need less room than `_graph`
# Corners of a prism that MuJoCo goes through one by one: climbing by `_graph`, it misses
# 11 in 100 contacts on a prism of 3, 4 of one of 4, 1 in 10,000 of one of 5, and none of 6 to 80.
_FEW = 8
_GOLDEN = np.pi * (3 - np.sqrt(5))


def add_room(spec: mujoco.MjSpec, count: int, name: str) -> None:
    """Add a geom with a mesh of `count` vertices to the world body."""
    number = np.arange(max(count, _LEAST))
    height = 1 - (2 * number + 1) / len(number)
    across = np.sqrt(1 - height**2)
    vertices = np.column_stack(
        [across * np.cos(_GOLDEN * number), across * np.sin(_GOLDEN * number), height]
    )
    mesh = spec.add_mesh(name=name)
    mesh.uservert = vertices.ravel()  # without faces, it has those of its hull
    # Not at the origin, or MuJoCo takes it that it never leaves it.
    add_collider(spec, mujoco.mjtGeom.mjGEOM_MESH, name, meshname=name, pos=[1, 1, 0])


def write_prism(model: mujoco.MjModel, geom: int, polygon: Floats, origin: Floats) -> None:
    """Let the geom be an upright prism, on either side of the plane of the sweep."""
    mesh, count = model.geom_dataid[geom], len(polygon)
    begin = model.mesh_vertadr[mesh]
    ends = model.mesh_vert[begin : begin + 2 * count].reshape(2, count, 3)
    ends[:, :, :2] = polygon - origin
    ends[0, :, 2], ends[1, :, 2] = -HALF_DEPTH, HALF_DEPTH
    model.geom_pos[geom] = [*origin, 0.0]
    model.geom_quat[geom] = [1, 0, 0, 0]
    model.geom_rbound[geom] = np.hypot(np.hypot(*(polygon - origin).T).max(), HALF_DEPTH)
    if count <= _FEW:
        model.mesh_graphadr[mesh] = -1
        model.mesh_vertnum[mesh] = 2 * count
        return
    graph = _graph(count)
    begin = model.mesh_graphadr[mesh]
    model.mesh_graph[begin : begin + len(graph)] = graph


@cache
def _graph(count: int) -> Integers:
    """What MuJoCo wants to know of the hull of a prism over `count` vertices.

    Numbers of vertices and faces; where the list of each vertex's neighbours begins; the vertices'
    numbers in the mesh; those lists, each with -1 at its end; and the faces. MuJoCo climbs from
    neighbour to neighbour: it has some that are far away, too, for speed.
    """
    this = np.arange(count)
    far = int(np.sqrt(count))
    ring = [np.roll(this, shift) for shift in (1, -1, far, -far)]
    lower = np.column_stack([*ring, this + count, np.full(count, -1)])
    upper = np.column_stack([*(part + count for part in ring), this, np.full(count, -1)])
    return np.concatenate(
        [
            [2 * count, 4 * count - 4],
            6 * np.arange(2 * count),
            np.arange(2 * count),
            np.concatenate([lower, upper]).ravel(),
            prism_faces(count).ravel(),
        ]
    )


def prism_faces(count: int) -> Integers:
    this = np.arange(count)
    after = np.roll(this, -1)
    fan = this[:1].repeat(count - 2), this[1:-1], this[2:]
    faces = [
        [this, after, this + count],
        [after, after + count, this + count],
        [fan[0], fan[2], fan[1]],
        [corner + count for corner in fan],
    ]
    return np.concatenate([np.transpose(part) for part in faces])
