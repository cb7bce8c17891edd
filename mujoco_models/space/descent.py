"""Where a vibrissa goes in space that has lost its hold: down its energy, all links off the body.

Its joints are as damped as they are stiff (Kelvin and Voigt's law). In a step they turn by the v
for which

    v . (E'' + m K) v/2 + E' . v   is least,   d_j + d_j' . v >= 0,

with the second derivative E'' of MuJoCo's energy, that of its springs K, and the distances d_j of
all links that are near the body, each at its nearest place. A large m makes the step gentle; with
m = 1/t it is one of time t by implicit differences. Where a side slides over a corner of a mesh
several links touch in turn, and one at a time would send it back and forth. On a smooth body there
is one contact, which slides along the vibrissa: links beside it that are as near to rounding would
hold it where no vibrissa is held.

E'' is negative along ways into the body, which are barred anyway: a large m because of them makes
a way past the end of a branch a creep. So for the links that pressed before, c (d_j + d_j' . v)^2/2
is added to the energy; it vanishes where they still press, and is left out where they do not.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from analytic.numerics.arrays import Booleans, Floats
from analytic.numerics.descent import barring_forces
from mujoco_models.space.balance import Linearised, State
from mujoco_models.space.model import SpaceModel, Touch
from mujoco_models.space.rest import Rest, Settled
from mujoco_models.space.surface import Surface, surface_at

_NUDGE = 1e-4  # rad, of the joint that turns most, where it begins
_INERTIA = 1.0  # m of the first step
_LEAST = 1e-9  # of m
_GENTLE = 1e-2  # rad, of a joint in a step
_STEPS = 100  # of 700 ways down that end, none took more than 67
_UNLOADED = 20  # steps in a row without a force, and the vibrissa is free
_SLOW, _PATIENCE = 1e-6, 20  # rad, of a step; so many in a row, and it will not come to rest soon
_NEAR = 0.02  # L; a link that is farther off the body does not touch in this step
_LANDED = 0.02  # L, of the contact: Newton's method that leads farther left the way down
_NEARLY = 1e-3  # EI/L, of balance, where Newton's method is tried
_HELD = 1e4  # EI/L^3, c above: more than E'' is negative by, and little to rounding
_SINGULAR = 1e-12  # of the constraints' own stiffness: two links that touch in one place


class _Near(NamedTuple):
    """A link near the body."""

    link: int
    s: float
    touch: Touch


def descend(rest: Rest, start: Settled, foot: Floats, far: float) -> Settled | None:
    """Where a vibrissa comes to rest that was stable until now."""
    model, state, inertia, unloaded, slow = rest.model, start.state, _INERTIA, 0, 0
    begin, pressing = model.contact(start.touch), {state.link}
    _, softest = rest.softest(start, foot)
    for number in range(_STEPS):
        model.place(foot, state.configuration)
        near = _near(model)
        if not near:
            return None
        touch = model.touch(state.link, state.s)
        if np.linalg.norm(model.contact(touch) - begin) > far:
            return None
        surface = surface_at(model, touch)
        state, system = _look(rest, state, surface, foot)
        landed = _landed(rest, state, system, surface, foot) if number else None
        if landed is not None:
            return landed
        model.place(foot, state.configuration)
        held = np.array([one.link in pressing for one in near])
        turns, forces, inertia = _turns(rest, system, system.curvature(state), near, held, inertia)
        if not number:
            turns = turns + _nudge(softest, turns)
        pressing = {one.link for one, force in zip(near, forces, strict=True) if force > 0}
        size = float(np.abs(turns).max())
        unloaded = 0 if forces.any() else unloaded + 1
        slow = slow + 1 if size < _SLOW else 0
        if unloaded > _UNLOADED:
            return None
        if slow > _PATIENCE:
            break
        configuration = state.configuration.copy()
        share = min(1.0, _GENTLE / max(size, 1e-300))
        mujoco.mj_integratePos(model.model, configuration, share * turns, 1.0)
        state = _pressed(model, configuration, near, forces)
        inertia = max(inertia * float(np.clip(size / _GENTLE, 0.5, 2.0)), _LEAST)
    return start._replace(stable=False)


def _near(model: SpaceModel) -> list[_Near]:
    """The links near the body, each at its nearest place."""
    found: list[tuple[float, int, float]] = []
    link = len(model.ends) - 1
    while link >= 0:
        distance, s = model.distance_of_link(link)
        if distance < _NEAR:
            found.append((distance, link, s))
        link -= max(1, int(distance / model.longest))
    if model.mesh is None:
        found = [min(found)] if found else []
    return [_Near(link, s, model.touch(link, s)) for _, link, s in found]


def _landed(
    rest: Rest, state: State, system: Linearised, surface: Surface, foot: Floats
) -> Settled | None:
    """The stable equilibrium next to a state that is nearly in balance."""
    if np.abs(system.springs + state.force * system.push).max() > _NEARLY:
        return None
    found = rest.settle(state, surface, foot, foot)
    if found is None or not (found.stays and found.stable):
        return None
    moved = float(np.linalg.norm(found.touch.centre - system.touch.centre))
    return found if moved < _LANDED else None


def _look(rest: Rest, state: State, surface: Surface, foot: Floats) -> tuple[State, Linearised]:
    """At the contact that presses most; a tip or a joint goes on from face to face."""
    state, touch = rest.balance.seen(state, surface, foot)
    turning = np.zeros((3, 3))
    feature = surface.feature
    if feature is not None and (feature.flat or not state.sliding):
        state = state._replace(sliding=False)
    else:
        turning = surface.turning(state.link, touch)
    slope = float(touch.normal @ rest.model.direction(state.link))
    return state, rest.balance.linearised(state, touch, slope, turning)


def _turns(
    rest: Rest,
    system: Linearised,
    curvature: Floats,
    near: list[_Near],
    held: Booleans,
    inertia: float,
) -> tuple[Floats, Floats, float]:
    """Turns of the joints, forces of the links near by, and the inertia that it took."""
    rows = np.array([rest.balance.push(one.link, one.touch) for one in near])
    distances = np.array([one.touch.distance for one in near])
    while True:
        barred = rows[held]
        stiffness = curvature + _HELD * (barred.T @ barred)
        stiffness.flat[:: len(stiffness) + 1] += inertia * system.own
        factor, failed = dpotrf(stiffness, lower=1)
        if failed:
            inertia *= 2.0  # or it would go up to the saddle
            continue
        moved = dpotrs(factor, rows.T, lower=1)[0]
        pulled = system.springs - _HELD * (distances[held] @ barred)
        turns = dpotrs(factor, pulled, lower=1)[0]
        gaps = distances + rows @ turns
        own = rows @ moved
        forces = barring_forces(own, gaps, _SINGULAR * float(np.trace(own)))
        if (forces[held] > 0).all():
            return turns + moved @ forces, forces, inertia
        held = held & (forces > 0)


def _pressed(model: SpaceModel, configuration: Floats, near: list[_Near], forces: Floats) -> State:
    """With one contact for all: a link that lies on a face shares its force with its ends."""
    force = float(forces.sum())
    most = near[int(np.argmax(forces))]
    s = most.s if force == 0 else float(forces @ [one.s for one in near]) / force
    link = min(int(np.searchsorted(model.ends, s)), len(model.ends) - 1)
    return State(configuration, link, s, force, False)


def _nudge(softest: Floats, turns: Floats) -> Floats:
    """Off an equilibrium that is not stable, to the side to which it is pulled anyway."""
    side = np.sign(softest @ turns) or 1.0
    return np.asarray(side * _NUDGE / np.abs(softest).max() * softest)
