"""Where a beam goes whose branch of equilibria has ended: down its energy, off the object.

In a step the links turn by the v for which

    v . (H + m K) v/2 - M . v   is least,   d_i + d_i' . v >= 0,

with the moments M of MuJoCo's springs, their stiffness K, what forces add to it in H, and the
distances d_i of all links near the object, each at its nearest place. A large m makes it gentle.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from analytic.problem.arrays import Floats
from mujoco_models.model.bead import BeadModel, Place, Touch
from mujoco_models.sweep.bead.balance import Balance, Settled, State

_INERTIA, _LEAST = 1.0, 1e-6  # m of the first step, and the least
_GENTLE = 2e-2  # rad, of a link in a step
_STEPS = 1000
_UNLOADED = 10  # steps in a row without a force, and the beam is free
_NEAR = 0.02  # L; a link that is farther off does not touch in this step
_NEARLY = 1e-2  # rad, of a step, after which Newton's method is tried
_HELD = (
    1e4  # EI/L^3, of links that pressed before: more than H is negative by, and little to rounding
)
_AT_REST = 1e-9  # rad, of a step
_SLOWER = 4  # steps in a row that become smaller, from which on Newton's method is tried


class _Near(NamedTuple):
    link: int
    place: Place
    touch: Touch


def fall(balance: Balance, start: Settled, foot_x: float) -> Settled | State | None:
    """The equilibrium it comes to, its last state if it comes to none, or None where it is free."""
    model, state, inertia, unloaded = balance.model, start.state, _INERTIA, 0
    forces: Floats = np.zeros(0)
    pressing: dict[int, float] = {state.link: state.force}
    before, slower, vain = 0.0, 0, False
    for _ in range(_STEPS):
        model.place(foot_x, state.angles)
        near = _near(model)
        if not near:
            return None
        turns, forces, inertia = _turns(model, state.angles, near, pressing, inertia)
        pressing = {one.link: float(f) for one, f in zip(near, forces, strict=True) if f > 0}
        size = float(np.abs(turns).max())
        unloaded = 0 if pressing else unloaded + 1
        if unloaded > _UNLOADED:
            return None
        turns *= min(1.0, _GENTLE / max(size, 1e-300))
        turns[1:] -= turns[:-1].copy()
        state = _pressed(state.angles + turns, near, forces)
        slower = slower + 1 if size < before else 0
        before = size
        if size < _AT_REST and vain:
            return state
        if pressing and size < _NEARLY and (slower > _SLOWER or size < _AT_REST):
            found = balance.converge(state, foot_x)
            if (
                found is not None
                and found.stable
                and found.state.force > 0
                and _is_near(found, state)
            ):
                return found
            vain = True
        inertia = max(inertia * float(np.clip(size / _GENTLE, 0.25, 4.0)), _LEAST)
    return state


def _is_near(found: Settled, state: State) -> bool:
    """Whether Newton's method has not left the way down."""
    turned = float(np.abs(np.cumsum(found.state.angles - state.angles)).max())
    return turned < 5 * _GENTLE


def _near(model: BeadModel) -> list[_Near]:
    """The links near the object, each at its nearest place."""
    found, link = [], len(model.ends) - 1
    while link >= 0:
        distance, s = model.distance_of(link)
        if distance < _NEAR:
            place = model.at(link, s)
            found.append(_Near(link, place, model.touch(link, place)))
        link -= max(1, int((distance - _NEAR) / model.longest))
    return found


def _turns(
    model: BeadModel, angles: Floats, near: list[_Near], pressing: dict[int, float], inertia: float
) -> tuple[Floats, Floats, float]:
    """Of the links in a step, the forces that keep them off, and the inertia that it took."""
    from scipy.optimize import nnls  # slow to load, and few sweeps fall

    count = len(angles)
    springs = model.stiffness(angles)
    own, beside = np.diag(springs), -springs[1:]
    own.flat[: (count - 1) * count : count + 1] += springs[1:]
    own.flat[1 :: count + 1], own.flat[count :: count + 1] = beside, beside
    pulled = model.springs.copy()
    pulled[:-1] -= model.springs[1:]
    rows, distances, bends = np.zeros((len(near), count)), np.empty(len(near)), np.zeros(count)
    pressed = np.array([pressing.get(one.link, 0.0) for one in near])
    held = pressed > 0
    for number, one in enumerate(near):
        normal, link = np.array(one.touch.normal), one.link
        ends = np.vstack([model.joints[: link + 1], [one.place.x, one.place.y]])
        arm = np.diff(ends, axis=0)
        rows[number, : link + 1] = arm @ [normal[1], -normal[0]]
        bends[: link + 1] += pressed[number] * (arm @ normal)
        distances[number] = one.touch.distance
    while True:
        barred = rows[held]
        stiffness = (1 + inertia) * own + np.diag(bends) + _HELD * (barred.T @ barred)
        factor, failed = dpotrf(stiffness, lower=1)
        if failed:
            inertia = 2 * inertia
            continue
        gaps = distances[held] + pressed[held] / model.contact_stiffness
        free, _ = dpotrs(factor, pulled - _HELD * (gaps @ barred), lower=1)
        moved, _ = dpotrs(factor, rows.T, lower=1)
        stiff = rows @ moved + np.eye(len(near)) / model.contact_stiffness
        root = np.linalg.cholesky(stiff)
        forces, _ = nnls(root.T, -np.linalg.solve(root, distances + rows @ free))
        if (forces[held] > 0).all():
            return free + moved @ forces, forces, inertia
        held = held & (forces > 0)


def _pressed(angles: Floats, near: list[_Near], forces: Floats) -> State:
    """With the contact that is pressed most."""
    most = near[int(np.argmax(forces))]
    return State(angles, most.link, most.place.s, float(forces.sum()), False)
