"""A one-dimensional flex with elasticity, MuJoCo 4's rod: where it is in a user's model."""

from dataclasses import dataclass
from typing import TypeAlias

import mujoco
import numpy as np

from analytic.numerics.arrays import Integers
from analytic.problem.errors import InputError

Chain: TypeAlias = tuple[int, ...]
"""Bodies that bend, from the clamp to the tip."""

_FEWEST = 3  # vertices that are free to move


@dataclass(frozen=True)
class Rod:
    """A flex of dimension 1 whose first two vertices are held."""

    flex: int  # its number
    # From the clamp to the tip; the first two are on one body, all others on one each.
    vertices: tuple[int, ...]
    chain: Chain  # the bodies of these others


def flexes(model: mujoco.MjModel) -> dict[Chain, int]:
    """Flexes of dimension 1 on vertices that slide."""
    slides = model.jnt_bodyid[model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE]
    found = {}
    for flex in np.flatnonzero(np.asarray(model.flex_dim) == 1).tolist():
        bodies = _bodies(model, flex)
        chain = tuple(bodies[np.isin(bodies, slides)].tolist())
        if len(chain) >= _FEWEST:
            found[chain] = flex
    return found


def _bodies(model: mujoco.MjModel, flex: int) -> Integers:
    first, count = int(model.flex_vertadr[flex]), int(model.flex_vertnum[flex])
    return np.asarray(model.flex_vertbodyid[first : first + count])


def rod_of(model: mujoco.MjModel, flex: int) -> Rod:
    """A flex of dimension 1 as a vibrissa."""
    bodies = _bodies(model, flex)
    vertices = int(model.flex_vertadr[flex]) + np.arange(len(bodies))
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_FLEX, flex) or ""
    first = int(model.flex_elemdataadr[flex])
    ends = model.flex_elem[first : first + 2 * (len(vertices) - 1)].reshape(-1, 2)
    if not np.array_equal(ends[:, 0] + 1, ends[:, 1]) or not np.array_equal(
        ends[:, 0], np.arange(len(ends))
    ):
        raise InputError(
            f"flex {name!r}", "with edges that branch or close a loop", "one line of edges",
            "take the type grid, or state its points in order",
        )  # fmt: skip
    # MuJoCo 3 has no such field.
    if not hasattr(model, "flex_bendingadr") or model.flex_bendingadr[flex] < 0:
        raise InputError(
            f"flex {name!r}", "without a stiffness in bending", "MuJoCo 4's elastic rod",
            "give it <elasticity young=.../>; before MuJoCo 4 a flex of dimension 1 does not bend",
        )  # fmt: skip
    if not model.flex_edgeequality[flex]:
        raise InputError(
            f"flex {name!r}", "with edges that nothing keeps at their lengths", "a beam",
            'constrain them: <edge equality="true" .../>',
        )  # fmt: skip
    if model.flex_edgestiffness[flex] or model.flex_edgedamping[flex]:
        raise InputError(
            f"flex {name!r}", "with springs or dampers in its edges", "one of constrained edges",
            "take stiffness and damping off <edge>: it is measured by MuJoCo's discrete steps, "
            "which have none",
        )  # fmt: skip
    if bodies[0] != bodies[1] and bodies[-1] == bodies[-2]:
        vertices, bodies = vertices[::-1], bodies[::-1]
    holder = int(bodies[0])
    if holder != bodies[1] or model.body_parentid[bodies[2]] != holder:
        raise InputError(
            f"flex {name!r}", "held by fewer than two vertices, so that it turns freely",
            "one that is clamped", 'pin its first edge: <pin id="0 1"/>',
        )  # fmt: skip
    return Rod(flex, tuple(vertices.tolist()), tuple(bodies[2:].tolist()))
