"""From a contact's stiffness and damping to MuJoCo's parameters, and back."""

from collections.abc import Sequence

from analytic.problem.errors import InputError
from analytic.problem.numbers import floats, positive, within

_LARGEST = 0.9999  # MuJoCo's own limits of an impedance
_LEAST = 1e-4
_DEFAULT = 0.02, 1.0  # what it takes for a solref of one number positive, and one not
_SHORTEST = 1e-15**0.5  # its smallest number is that of a square


def to_solref(
    stiffness: float, damping: float, inverse_mass: float, impedance: float = 0.9
) -> tuple[tuple[float, float], tuple[float, float, float]]:
    """MuJoCo's parameters of a contact that is as stiff and as damped as stated.

    Parameters
    ----------
    stiffness : float
        Force over depth at rest, of one contact [N/m].
    damping : float
        Force over speed of approach [N s/m]. The contact is critically damped with
        2 sqrt(stiffness (1 - impedance)/inverse_mass)/(1 - impedance).
    inverse_mass : float
        Of the two bodies along the normal, as MuJoCo takes it: the sum of their
        ``body_invweight0[:, 0]``; with ``integrator="discrete"`` less, see `README.md` [1/kg].
    impedance : float
        MuJoCo's d, the same at all depths.

    Returns
    -------
    solref : tuple of float
        In MuJoCo's direct form, (-k, -b).
    solimp : tuple of float
        (d, d, width); of equal impedances the width does not matter.

    Raises
    ------
    InputError
        If a number is not positive, or the impedance is not from 0.0001 to 0.9999.
    """
    stiffness, damping = positive("stiffness", stiffness), positive("damping", damping)
    impedance = within("impedance", impedance, _LEAST, _LARGEST, "0.9 is MuJoCo's")
    yielding = (1 - impedance) * positive("inverse_mass", inverse_mass)
    return (-stiffness * yielding, -damping * yielding), (impedance, impedance, 1e-3)


def from_solref(
    solref: Sequence[float],
    solimp: Sequence[float],
    inverse_mass: float,
    depth: float = 0.0,
    timestep: float = 0.0,
) -> tuple[float, float]:
    """Stiffness and damping of a contact with MuJoCo's parameters.

    Parameters
    ----------
    solref : sequence of float
        Two of them, in either form: (time constant [s], damping ratio), or (-k, -b). Of one that
        is both MuJoCo takes its default, (0.02, 1).
    solimp : sequence of float
        Impedance at no depth and at `width`, width [m], and, if they are not MuJoCo's 0.5 and 2,
        midpoint and power.
    inverse_mass : float
        As of `to_solref` [1/kg].
    depth : float
        Where it is asked for: an impedance that changes with the depth makes a contact's force
        another function of it [m].
    timestep : float
        MuJoCo takes no time constant below twice this [s].

    Returns
    -------
    stiffness : float
        Force over depth at rest [N/m].
    damping : float
        Force over speed of approach [N s/m].

    Raises
    ------
    InputError
        If a number is not finite, the inverse mass not positive, or depth or time step negative.
    """
    impedances = floats("solimp", solimp, (None,), "numbers").tolist()
    if not 2 <= len(impedances) <= 5:
        raise InputError("solimp", solimp, "two to five numbers", "as (0.9, 0.95, 0.001)")
    return pushes(
        floats("solref", solref, (2,), "two numbers, as (0.02, 1)").tolist(),
        impedances,
        positive("inverse_mass", inverse_mass),
        within("depth", depth, 0.0, remedy="it is positive inside the object"),
        within("timestep", timestep, 0.0),
    )


def pushes(
    solref: Sequence[float],
    solimp: Sequence[float],
    inverse_mass: float,
    depth: float,
    timestep: float,
) -> tuple[float, float]:
    """Of any numbers that a compiled model may hold, as `from_solref` has it."""
    first, second = solref if (solref[0] > 0) == (solref[1] > 0) else _DEFAULT
    d = impedance_at(solimp, depth)
    largest = min(max(solimp[1], _LEAST), _LARGEST)
    if first > 0:
        constant = largest * max(first, 2 * timestep)
        rate = 1 / max(constant * second, _SHORTEST)
        k, b = rate * rate, 2 / constant
    else:
        k, b = -first / largest**2, -second / largest
    yielding = (1 - d) * inverse_mass
    return k * d**2 / yielding, b * d / yielding


def impedance_at(solimp: Sequence[float], depth: float) -> float:
    """MuJoCo's d at a depth: a power of it up to the midpoint, and the same turned round after."""
    low, high = (min(max(x, _LEAST), _LARGEST) for x in solimp[:2])
    width, middle, power = (*solimp[2:], *(1e-3, 0.5, 2.0)[len(solimp) - 2 :])
    x = min(depth / width, 1.0) if width > 0 else 1.0
    if power == 1 or x in (0, 1):
        share = x
    elif x <= middle:
        share = x**power / middle ** (power - 1)
    else:
        share = 1 - (1 - x) ** power / (1 - middle) ** (power - 1)
    return low + share * (high - low)
