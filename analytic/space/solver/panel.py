r"""The curve of states, panel by panel, by collocation.

Along a panel all of a state is a polynomial of what grows along the curve's tangent at its begin.
Without friction each state is at rest on its own, and polynomials say nearly where. With friction
it starts from what it was at the panel's begin. At Radau's points it is at rest, and obeys
Coulomb's law: while it slides the velocity v of the vibrissa's point along the body, the
polynomials' slope, is along friction, v . (n x rub) = 0 and |rub| = mu; while it sticks v = 0.
Radau's method damps, however stiff a law is: the less friction there is the faster its direction
follows the velocity, and at first contact, where f rub' = G(rub, f), at once.
"""

import operator
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Legendre, legendre
from scipy.optimize import brentq

from analytic.numerics.arrays import Floats
from analytic.numerics.vectors import cross
from analytic.space.solver.contact import Scene
from analytic.space.solver.sliding import (
    BY_TRAVEL,
    LENGTH,
    RUB,
    TRAVEL,
    TURNED,
    Leg,
    Sliding,
    changed,
    end_rates,
    equations,
    grows,
    state_of,
)

_POINTS = 8
_STEPS = 12  # of Newton's method
_WILD = 1.0  # L and rad, of any of them
# Of its last step; where the force is so small that rounding leaves more, what that leaves.
_EXACT, _ROUNDING = 1e-12, 1e-7
_LEFT = 1e-10  # L, rad and of friction over the normal force: of the polynomials' last terms
_OF_ROUNDING = 4.0  # times what it leaves of a state: it may be in the last terms of eight
_GUESSED = 1e-5  # the same without friction, where a state needs no other one
_NEARLY = 1e-9  # of such a state's equations
_UP_TO_RELEASE = 0.999  # of the way to where a tip, that a body can only push, is straight
_SHARE = 1e-15  # of a panel, to which a place on it is enclosed
FAINT = 1e-2
"""EI/L^2; rounding leaves no direction of so little friction, and readings hardly any of it."""
_ELSEWHERE = 1e-6  # of friction, beside the curve
_GONE = 16.0  # e-folds: rounding of 1e-16 of friction's direction is 1e-9, and goes on growing
_AT_REST = 1e-15  # of the equations, by the extent


def _radau() -> Floats:
    last = Legendre.basis(_POINTS) - Legendre.basis(_POINTS - 1)
    return np.concatenate([[0.0], (np.sort(last.roots().real) + 1) / 2])


POINTS = _radau()  # shares of a panel: its begin, and Radau's points with its end
_SERIES = np.linalg.inv(legendre.legvander(2 * POINTS - 1, _POINTS))
_SLOPES = 2 * legendre.legvander(2 * POINTS - 1, _POINTS - 1) @ legendre.legder(_SERIES)
_LOOKED_AT = 1, 3, 5, 7, 8  # of them: where friction may go astray
_SHARES = (np.arange(64) + 0.5) / 64
_BETWEEN = legendre.legvander(2 * _SHARES - 1, len(_LOOKED_AT) - 1) @ np.linalg.inv(
    legendre.legvander(2 * POINTS[list(_LOOKED_AT)] - 1, len(_LOOKED_AT) - 1)
)


def _legendre(share: float) -> list[float]:
    """Legendre's polynomials at a share of a panel; NumPy's take twenty times as long for one."""
    x = 2 * share - 1
    found = [1.0, x]
    for n in range(1, _POINTS):
        found.append(((2 * n + 1) * x * found[n] - n * found[n - 1]) / (n + 1))
    return found


class Law(NamedTuple):
    """Coulomb's, of a contact that slides, or sticks, along a straight part of the way."""

    leg: Leg
    friction: float
    sticks: bool

    @property
    def rubs(self) -> bool:
        """Whether it slides with friction."""
        return self.friction > 0 and not self.sticks

    def ways(self, state: Sliding) -> Floats:
        """Directions along the body in which the velocity vanishes, shape (0 to 2, 3)."""
        if not self.rubs:
            return state.sides if self.sticks else np.zeros((0, 3))
        return cross(state.contact.spot.normal, state.rub)[None] / self.friction

    def missed(self, state: Sliding) -> Floats:
        """What vanishes at rest with such friction, shape (5 to 7,)."""
        contact = state.contact
        phase = -state.leans_in if contact.tangent else contact.arc_length - 1
        off = float(contact.plane.normal @ state.beside)
        found = [*(contact.foot - self.leg.foot(state.travel)), off, phase]
        if self.rubs:
            found.append((float(state.rub @ state.rub) / self.friction - self.friction) / 2)
        elif not self.sticks:
            found.extend(state.sides @ state.rub)
        return np.array(found)

    def rows(self, state: Sliding) -> Floats:
        """The rates of that, shape (5 to 7, 8)."""
        found = equations(state, self.leg.onward)
        if not self.rubs:
            return found if self.sticks else np.vstack([found, np.eye(8)[RUB]])
        size = np.zeros(8)
        size[RUB] = state.sides @ state.rub / self.friction
        return np.vstack([found, size])

    def along_curve(self, state: Sliding) -> Floats:
        """Rates as the foot goes on, shape (8,); at first contact friction keeps its direction."""
        ways = self.ways(state)
        law = self.slips(state)
        if state.contact.force == 0:
            law[:, RUB] = ways @ state.sides.T
        found = np.linalg.svd(np.vstack([self.rows(state), law]))[2][-1]
        return np.asarray(found * np.sign(found[TRAVEL]))

    def slips(self, state: Sliding) -> Floats:
        """Of rates, how fast it moves along the body where it must not, shape (0 to 2, 8)."""
        ways = self.ways(state)
        found = np.zeros((len(ways), 8))
        found[:, :2] = ways @ state.moved
        found[:, LENGTH] = -(ways @ state.end)
        return found

    def settled(
        self, scene: Scene, near: Sliding, by: Floats, amount: float, enough: float = _AT_REST
    ) -> Sliding | None:
        """At rest, where weighted parts of the state come to an amount: the nearest such state."""
        state, missed = near, np.inf
        extent = max(1.0, float(np.abs(near.contact.foot).max()))
        for _ in range(_STEPS):
            miss = np.append(self.missed(state), by @ state.vector - amount)
            last, missed = missed, float(np.abs(miss).max()) / extent
            if missed <= enough or (missed > last / 4 and missed <= 100 * _AT_REST):
                return state
            rows = np.vstack([self.rows(state), grows(state, by)])
            if not np.isfinite(rows).all() or missed > _WILD:
                return None
            if self.friction:
                step = np.asarray(-rows.T @ np.linalg.solve(rows @ rows.T, miss))
            else:  # where it slips off, their square is singular to rounding
                step = -np.linalg.lstsq(rows, miss)[0]
            vector = state.vector + changed(state, step)
            state = state_of(scene, vector, state.contact.tangent)
        return None


class Panel(NamedTuple):
    """A part of the curve."""

    scene: Scene
    law: Law
    by: Floats  # weights of the state's vector: what grows along the panel
    reach: float
    states: list[Sliding]  # at `POINTS`
    series: Floats  # of their vectors, by Legendre's polynomials
    rates: Floats  # of what moves, likewise
    rounding: float  # L, rad and of friction over the normal force: what it leaves of a state

    @property
    def coarse(self) -> float:
        """How much its polynomials leave, over what they may."""
        left = float(np.abs(self.series[-1]).max()) - _OF_ROUNDING * self.rounding
        return max(left, 0.0) / (_LEFT if self.law.friction else _GUESSED)

    @property
    def rounded(self) -> float:
        """How wrong the rates are at most by rounding: the last polynomial's at the ends."""
        return _POINTS**2 * _OF_ROUNDING * self.rounding / self.reach

    def aside(self, point: int) -> Floats:
        """Direction across the curve to what friction elsewhere would make of it, shape (12,)."""
        along = _SLOPES[point] @ [one.vector for one in self.states]
        state = self.states[point]
        ways = [changed(state, rates) for rates in np.linalg.svd(self.law.rows(state))[2][-2:]]
        found = (ways[1] @ along) * ways[0] - (ways[0] @ along) * ways[1]
        return np.asarray(found / np.sqrt(found @ found))

    def beside(self, point: int, aside: Floats) -> tuple[float, float]:
        """How fast it slips by how far it is beside the curve, and what going aside takes of that.

        Their quotient says how fast such a distance decays along the curve; where it grows, it
        slides so in no experiment, and but for rounding in no solution.
        """
        law, state, step = self.law, self.states[point], _ELSEWHERE * self.law.friction

        def slips(one: Sliding, *amounts: float) -> float:
            """At rest, by how fast it goes along and aside."""
            rows = np.vstack([law.rows(one), grows(one, self.by), grows(one, aside)])
            return float(law.slips(one)[0] @ np.linalg.solve(rows, [*np.zeros(6), *amounts]))

        near = state_of(self.scene, state.vector + step * aside, state.contact.tangent)
        return slips(near, 1.0, 0.0) / step, slips(state, 0.0, 1.0)

    def astray(self, so_far: float, end: float) -> float:
        """Logarithm of how much another direction of friction has grown, up to a share of it."""
        if not self.law.rubs:
            return 0.0
        if min(self.states[point].contact.force for point in _LOOKED_AT) < FAINT:
            return so_far
        asides = np.array([self.aside(point) for point in _LOOKED_AT])
        asides *= np.sign(asides @ asides[0])[:, None]
        beside = [self.beside(*each) for each in zip(_LOOKED_AT, asides, strict=True)]
        decays = np.divide(*np.transpose(beside))
        if (decays > 0).all():  # between them steep polynomials may not be so
            return max(0.0, so_far - float(decays.min()) * self.reach * end)
        slips, turning = (_BETWEEN @ beside).T
        within = (POINTS[1] < _SHARES) & (end > _SHARES)  # at first contact it is steep before
        for less in (slips / turning)[within] * self.reach / len(_SHARES):
            so_far = max(0.0, so_far - less)
            if so_far > _GONE:
                return np.inf  # elsewhere it does not come back
        return so_far

    def share_at(self, travel: float, last: float) -> float:
        """Where the foot has come so far; it goes on until the last share, at least."""
        travels = self.series[:, -1].tolist()

        def ahead(share: float) -> float:
            return float(sum(map(operator.mul, _legendre(share), travels))) - travel

        if ahead(0.0) >= 0:
            return 0.0
        return float(brentq(ahead, 0.0, last, xtol=_SHARE)) if ahead(last) > 0 else last

    def beyond(self, share: float) -> Floats:
        """The vector of its polynomials, also past its end."""
        return np.asarray(_legendre(share) @ self.series)

    def at(self, share: float, travel: float | None = None) -> Sliding:
        """The state at a share of the panel, or where the foot has come so far."""
        tangent = self.states[-1].contact.tangent
        near = state_of(self.scene, self.beyond(share), tangent)
        by, amount = self.by, float(self.by @ self.states[0].vector) + share * self.reach
        if travel is not None:
            by, amount = BY_TRAVEL, travel
        found = self.law.settled(self.scene, near, by, amount)
        return near if found is None else found

    def velocity(self, share: float, state: Sliding) -> tuple[Floats, float]:
        """Of the vibrissa's point along the body, and the foot's speed, along the panel."""
        grows = _legendre(share)[:-1] @ self.rates
        return grows[:3] - grows[3] * state.end, float(grows[4])


@np.errstate(invalid="ignore")  # what is tried inside a body has no normal, and is no state
def panel(
    scene: Scene, law: Law, start: Sliding, reach: float, before: Panel | None = None
) -> Panel | None:
    """On from a state, along the tangent or as the panel before; none if Newton's method fails."""
    if not np.isfinite(equations(start, law.leg.onward)).all():
        return None
    by = changed(start, law.along_curve(start))
    by = by / np.sqrt(by @ by)
    if not law.friction and not start.contact.tangent and by[TURNED] < 0:
        reach = min(reach, _UP_TO_RELEASE * start.rotation / -by[TURNED])
    amounts = float(by @ start.vector) + reach * POINTS[1:]
    if before is None:
        vectors = start.vector + np.outer(reach * POINTS[1:], by)
    else:
        vectors = np.array([before.beyond(1 + reach / before.reach * x) for x in POINTS[1:]])
    near = [state_of(scene, vector, start.contact.tangent) for vector in vectors]
    if law.friction:
        settled = _collocated(scene, law, start, near, reach, by, amounts)
    else:
        settled = _each_settled(scene, law, near, by, amounts)
    if settled is None:
        return None
    states, rounding = settled
    found = [start, *states]
    series = _SERIES @ np.array([state.vector for state in found])
    rates = np.asarray(2 * legendre.legder(_SERIES @ _moving(found)) / reach, dtype=float)
    return Panel(scene, law, by, reach, found, series, rates, rounding)


def _each_settled(
    scene: Scene, law: Law, near: list[Sliding], by: Floats, amounts: Floats
) -> tuple[list[Sliding], float] | None:
    """States without friction, from the last one on, which fails first; no rounding counts."""
    found = []
    for state, amount in zip(near[::-1], amounts[::-1], strict=True):
        # The less it is bent the less it takes to turn the plane in which it is.
        enough = max(_NEARLY * min(1.0, abs(state.rotation)), _AT_REST)
        settled = law.settled(scene, state, by, amount, enough)
        if settled is None:
            return None
        found.append(settled)
    return found[::-1], 0.0


def _collocated(
    scene: Scene,
    law: Law,
    start: Sliding,
    states: list[Sliding],
    reach: float,
    by: Floats,
    amounts: Floats,
) -> tuple[list[Sliding], float] | None:
    """States with friction, all at once, and what rounding leaves of them."""
    size = np.inf
    for _ in range(_STEPS):
        matrix, missed = _system(law, start, states, reach, by, amounts)
        if not np.isfinite(matrix).all():
            return None
        try:
            steps = np.asarray(np.linalg.solve(matrix, -missed), dtype=float).reshape(_POINTS, 8)
        except np.linalg.LinAlgError:
            return None
        last, size = size, float(np.abs(steps).max())
        if not size < _WILD:
            return None
        both = zip(states, steps, strict=True)
        states = [
            state_of(scene, one.vector + changed(one, step), start.contact.tangent)
            for one, step in both
        ]
        if size <= _EXACT:
            return states, 0.0
        if last / 4 < size <= _ROUNDING:
            return states, size
    return None


def _system(
    law: Law, start: Sliding, states: list[Sliding], reach: float, by: Floats, amounts: Floats
) -> tuple[Floats, Floats]:
    """Newton's matrix of all points of a panel, and what they miss."""
    moving = _SLOPES[1:] @ _moving([start, *states]) / reach
    slopes = _SLOPES[1:, 1:] / reach
    matrix, missed = np.zeros((_POINTS, 8, _POINTS, 8)), np.zeros((_POINTS, 8))
    for i, (state, amount) in enumerate(zip(states, amounts, strict=True)):
        ways, speed = law.ways(state), moving[i, 3]
        rest = 7 - len(ways)
        velocity = moving[i, :3] - speed * state.end
        missed[i, :rest] = law.missed(state)
        missed[i, rest:7], missed[i, 7] = ways @ velocity, by @ state.vector - amount
        for j, other in enumerate(states):
            matrix[i, rest:7, j, :2] = slopes[i, j] * ways @ other.moved
            matrix[i, rest:7, j, LENGTH] = -slopes[i, j] * (ways @ state.end)
        own = matrix[i, :, i]
        own[:rest], own[7] = law.rows(state), grows(state, by)
        own[rest:7] -= speed * ways @ end_rates(state)
        if law.rubs:
            turned = cross(state.rub, velocity) @ state.turned
            own[6, :2] += turned / law.friction
            own[6, RUB] += state.sides @ cross(velocity, state.contact.spot.normal) / law.friction
    return matrix.reshape(8 * _POINTS, -1), missed.ravel()


def _moving(states: list[Sliding]) -> Floats:
    """The vibrissa's axis at the contact, arc length, and the foot's travel, shape (n, 5)."""
    return np.array(
        [[*state.contact.centre, state.contact.arc_length, state.travel] for state in states]
    )
