"""The named cases: the paper's contours and two more, in one table."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from analytic.problem.case import Case
from analytic.problem.contours.contour import Contour
from analytic.problem.contours.kinds import CONTOURS
from analytic.problem.errors import InputError

NAMED_PROFILES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "catenary": {"kind": "catenary", "a": 0.5, "c": -0.8},  # the paper's g1
        "parabola": {"kind": "parabola", "a": 0.5, "c": 0.5},  # g2
        "two-circles": {"kind": "two-circles"},  # g3
        "shallow-catenary": {"kind": "catenary", "a": 0.25, "c": -0.8},  # that of fig. 12
        "tip-only": {"kind": "catenary", "a": 0.5, "c": -0.2},  # g1 raised by 0.6: no Phase B
    }
)
"""The contours of the named cases, as the ``[profile]`` tables of their case files."""

CASE_NAMES = tuple(NAMED_PROFILES)


def named_contour(name: str) -> Contour:
    """The contour of one of the named cases.

    Parameters
    ----------
    name : str
        One of `CASE_NAMES`.

    Returns
    -------
    Contour
        In units of the vibrissa's length.
    """
    numbers = dict(NAMED_PROFILES[name])
    return CONTOURS[numbers.pop("kind")](**numbers)


def named_case(name: str) -> Case:
    """One of the named cases, with the default beam and sweep.

    Parameters
    ----------
    name : str
        One of `CASE_NAMES`.

    Returns
    -------
    Case
        The problem.

    Raises
    ------
    InputError
        If there is no case of that name.
    """
    if name not in NAMED_PROFILES:
        raise InputError(
            "case",
            repr(name),
            f"one of {', '.join(CASE_NAMES)}, or a TOML file",
            "see `vibrissa cases`",
        )
    return Case(profile=named_contour(name), name=name)
