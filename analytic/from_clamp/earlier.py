"""How others found the contact from the same readings, before there was a closed form.

Dimensionless, L = EI = 1; the vibrissa stands upright on its foot and is bent to the right.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.roots import zeros

_TOLERANCE = 1e-13
_PLACES = np.linspace(0, 1, 129)  # among which the moment's first zero is looked for [L]
_NEWTON = 4  # steps from there on; the third is at rounding
_BLOCK = 500  # stations that are integrated together
_AT_TIP = 0.05  # of the clamp's moment may be left at the tip: the errors of good readings


class LoadedStations(NamedTuple):
    """Loaded stations of a sweep, arrays of shape (n,)."""

    foot_x: Floats  # foot position [L]
    across: Floats  # force of the clamp across the vibrissa, -F_x, Q in the formulas [EI/L^2]
    along: Floats  # force of the clamp along the vibrissa, F_y, P in the formulas [EI/L^2]
    moment: Floats  # moment of the clamp, M [EI/L]
    travel: Floats  # way of the foot since the first contact [L]


class Answer(NamedTuple):
    """The contact on the vibrissa's axis, arrays of shape (n,); NaN where there is no answer."""

    x: Floats
    y: Floats  # position [L]

    def where(self, valid: Booleans) -> "Answer":
        """The same, with no answer where a method's assumptions do not hold."""
        return Answer(*(_masked(values, valid) for values in self))


def _masked(values: Floats, valid: Booleans) -> Floats:
    found = values.copy()
    found[~valid] = float("nan")
    return found


def binary(sensed: LoadedStations) -> Answer:
    """The tip of the straight vibrissa, wherever there is a load: contact or no contact."""
    return Answer(sensed.foot_x, np.ones_like(sensed.foot_x))


def from_moment_and_travel(sensed: LoadedStations) -> Answer:
    """The height of a point object that a cantilever is pushed against, from moment and travel.

    A cantilever that is displaced by delta at the height eta has the moment 3 delta/eta^2 at its
    clamp (the idea of M. Kaneko, N. Kanayama and T. Tsuji, Active antenna for contact sensing,
    IEEE Transactions on Robotics and Automation 14, 1998, for a translation; derived here).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        height = np.sqrt(3 * sensed.travel / sensed.moment)
    return _at(sensed.foot_x + sensed.travel, height)


def from_slope_and_travel(sensed: LoadedStations, sensor: float = 0.05) -> Answer:
    """The same from the slope at a short distance from the clamp; needs no flexural rigidity.

    With the slope tau at the distance x of the sensor and the travel delta, the height d solves
    2 tau d^3 - 6 delta x d + 3 delta x^2 = 0, its largest root (the idea of D. Kim and R. Moeller,
    Biomimetic whiskers for shape recognition, Robotics and Autonomous Systems 55, 2007; derived
    here). The slope is what the clamp's readings make of it, M x - Q x^2/2.
    """
    slope = sensor * sensed.moment - sensor**2 * sensed.across / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        # d^3 - 3 a d + b = 0 has the largest root 2 sqrt(a) cos(arccos(-b/(2 a^1.5))/3).
        a = sensed.travel * sensor / slope
        b = 1.5 * sensed.travel * sensor**2 / slope
        height = 2 * np.sqrt(a) * np.cos(np.arccos(-b / (2 * a**1.5)) / 3)
    return _at(sensed.foot_x + sensed.travel, height)


def from_force_and_moment(sensed: LoadedStations) -> Answer:
    """A cylinder of small deflection: the lever a = M/Q, and the deflection Q a^3/3 there.

    After J. A. Birdwell and others, Biomechanical models for radial distance determination by the
    rat vibrissal system, Journal of Neurophysiology 98, 2007.
    """
    lever, deflection = _lever(sensed), sensed.across
    with np.errstate(over="ignore", invalid="ignore"):
        return _at(sensed.foot_x + deflection * lever**3 / 3, lever)


def from_force_and_moment_of_cone(sensed: LoadedStations) -> Answer:
    """A cone that ends in a point: the lever a = M/Q, the deflection Q a^3/(3 (1 - a)) there.

    After Birdwell and others, as `from_force_and_moment`; the flexural rigidity at the base is 1.
    """
    lever = _lever(sensed)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        deflection = sensed.across * lever**3 / (3 * (1 - lever))
    return _at(sensed.foot_x + deflection, lever).where(lever < 1)


def from_beam_column(sensed: LoadedStations) -> Answer:
    """Second-order theory: small slopes, but the force along the beam bends it, too.

    M = Q tan(k a)/k with k^2 = P gives the height a, and the deflection is (Q/P)(tan(k a)/k - a);
    S. P. Timoshenko and J. M. Gere, Theory of elastic stability, 1961, section 1.11.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        k = np.sqrt(sensed.along)
        height = np.arctan(k * sensed.moment / sensed.across) / k
        deflection = (sensed.moment - sensed.across * height) / sensed.along
    return _at(sensed.foot_x + deflection, height)


def _lever(sensed: LoadedStations) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return sensed.moment / sensed.across


def _at(x: Floats, y: Floats) -> Answer:
    """That point, if it is above the clamp."""
    with np.errstate(invalid="ignore"):
        return Answer(x, y).where(np.isfinite(x) & (y > 0))


class BaseSeen(NamedTuple):
    """The base as seen from the contact, whose tangent is the x-axis; arrays of shape (n,)."""

    x: Floats
    y: Floats
    turned: Floats


def by_segments(sensed: LoadedStations, segments: int = 40, half_cell: bool = False) -> Answer:
    """The contact from which straight segments turn the base by as much as the force says.

    B. W. Quist and M. J. Z. Hartmann, Mechanical signals at the base of a rat vibrissa: the effect
    of intrinsic vibrissa curvature and implications for tactile exploration, Journal of
    Neurophysiology 107, 2012. Their model takes the force to be normal to the vibrissa, which it is
    at a tangential contact; at the tip it is not, and the answer is off whatever the number of
    segments.
    """
    force = np.hypot(sensed.across, sensed.along)
    # Where the force is normal to the vibrissa, at the contact, the base is turned away by so much.
    turn = np.arctan2(sensed.along, sensed.across)
    half = 0.5 / segments if half_cell else 0.0
    size, every = np.full_like(force, 1 / segments), np.ones_like(force)
    enough = np.array(
        [bent_from(force, size, n * every, segments, half).turned >= turn for n in range(segments)]
    )
    found, whole = np.asarray(enough.any(axis=0)), enough.argmax(axis=0).astype(float)
    at = np.flatnonzero(found & (turn > 0))

    def beyond(which: Integers, rest: Floats) -> Floats:
        some = at[which]
        return bent_from(force[some], rest, whole[some], segments, half).turned - turn[some]

    rest = np.zeros_like(force)  # a contact that turns nothing away is at the base
    rest[at] = zeros(beyond, rest[at], size[at])
    across, height = from_base(bent_from(force, rest, whole, segments, half))
    return Answer(sensed.foot_x + across, height).where(found)


def from_base(seen: BaseSeen) -> tuple[Floats, Floats]:
    """The contact as the base sees it: to the side, and along its tangent."""
    cos, sin = np.cos(seen.turned), np.sin(seen.turned)
    return np.abs(cos * seen.y - sin * seen.x), -(cos * seen.x + sin * seen.y)


def bent_from(force: Floats, rest: Floats, whole: Floats, segments: int, half: float) -> BaseSeen:
    """From a contact at `rest` beyond so many whole segments, joint by joint."""
    h = 1 / segments
    x, y, turned = -rest, np.zeros_like(force), np.zeros_like(force)
    for number in range(int(whole.max(initial=0))):
        there = number < whole
        turned = np.where(there, turned - force * x * h, turned)
        x = np.where(there, x - h * np.cos(turned), x)
        y = np.where(there, y - h * np.sin(turned), y)
    return BaseSeen(x, y, turned - half * x * force)


def up_to_zero(sensed: LoadedStations) -> Answer:
    """Integrate the elastica up to the first zero of its moment, or to the tip.

    In the plane: G. R. Scholz and C. D. Rahn, Profile sensing with an actuated whisker, IEEE
    Transactions on Robotics and Automation 20, 2004. In space it is T. N. Clements and C. D. Rahn,
    Three-dimensional contact imaging with an actuated whisker, IEEE Transactions on Robotics 22,
    2006, and a sweep in a plane is the same.
    """
    starts = range(0, len(sensed.moment), _BLOCK)
    blocks = [LoadedStations(*(values[i : i + _BLOCK] for values in sensed)) for i in starts]
    x, y = np.concatenate([np.zeros((2, 0)), *map(_integrated, blocks)], axis=1)
    return Answer(sensed.foot_x + x, y)


def _integrated(sensed: LoadedStations) -> Floats:
    """Contacts as seen from the foot, (2, n); NaN where too much moment is left at the tip."""
    from scipy.integrate import solve_ivp  # slow to load, and few methods need it

    n = len(sensed.moment)

    def left(state: Floats) -> Floats:
        x, y, _ = state
        return np.asarray(sensed.moment - sensed.along * x - sensed.across * y)

    def rate(_: float, state: Floats) -> Floats:
        here = state.reshape(3, n)
        return np.concatenate([np.cos(here[2]), np.sin(here[2]), -left(here)])

    start = np.repeat([0.0, 0.0, np.pi / 2], n)
    way = solve_ivp(
        rate,
        (0.0, 1.0),
        start,
        method="DOP853",
        rtol=_TOLERANCE,
        atol=_TOLERANCE,
        dense_output=True,
    ).sol
    assert way is not None  # asked for

    def at(s: Floats) -> Floats:
        """Each station's state at its own arc length."""
        return np.asarray(np.einsum("knn->kn", way(s).reshape(3, n, n)))

    profile = np.array([left(way(s).reshape(3, n)) for s in _PLACES])
    falls = (profile[:-1] > 0) & (profile[1:] <= 0)
    crosses = falls.any(axis=0)
    last = np.where(crosses, falls.argmax(axis=0) + 1, len(_PLACES) - 1)
    s = _PLACES[last]
    for _ in range(_NEWTON):
        here = at(s)
        falling = sensed.along * np.cos(here[2]) + sensed.across * np.sin(here[2])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(falling > 0, left(here) / falling, 0.0)
        s = np.clip(s + step, _PLACES[last - 1], _PLACES[last])
    near_tip = np.abs(profile[-1]) < _AT_TIP * sensed.moment
    return np.where(crosses | near_tip, at(s)[:2], np.nan)


@dataclass(frozen=True)
class Method:
    source: str  # author and year
    # What it has to know: of ``"moment"``, ``"force"``, ``"rigidity"``, ``"first contact"``,
    # ``"slope"`` and ``"length"``.
    needs: tuple[str, ...]
    estimate: Callable[[LoadedStations], Answer]  # the contact on the vibrissa's axis


METHODS: dict[str, Method] = {
    "binary": Method(
        "binary whiskers of mobile robots",
        ("moment", "length"),
        binary,
    ),
    "kaneko": Method(
        "Kaneko, Kanayama and Tsuji 1998",
        ("moment", "rigidity", "first contact"),
        from_moment_and_travel,
    ),
    "kim-moeller": Method(
        "Kim and Moeller 2007",
        ("slope", "first contact"),
        from_slope_and_travel,
    ),
    "birdwell": Method(
        "Birdwell and others 2007",
        ("moment", "force", "rigidity"),
        from_force_and_moment,
    ),
    "birdwell-cone": Method(
        "Birdwell and others 2007",
        ("moment", "force", "rigidity"),
        from_force_and_moment_of_cone,
    ),
    "beam-column": Method(
        "Timoshenko and Gere 1961",
        ("moment", "force", "rigidity"),
        from_beam_column,
    ),
    "scholz-rahn": Method(
        "Scholz and Rahn 2004",
        ("moment", "force", "rigidity", "length"),
        up_to_zero,
    ),
    "clements-rahn": Method(
        "Clements and Rahn 2006",
        ("moment", "force", "rigidity", "length"),
        up_to_zero,
    ),
    "quist-hartmann": Method(
        "Quist and Hartmann 2012",
        ("force", "rigidity", "length"),
        by_segments,
    ),
    "quist-hartmann-half-cell": Method(
        "Quist and Hartmann 2012, with half a segment that bends at the clamp",
        ("force", "rigidity", "length"),
        partial(by_segments, half_cell=True),
    ),
}

OWN = ("elastica", "decision")
"""The paper's: in closed form, and its way to decide the phase first and integrate then."""
NAMES = (*METHODS, *OWN)
