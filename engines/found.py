"""Which engines there are, and whether they can be used here."""

from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from inspect import signature
from typing import Any, Literal, get_args

from packaging.requirements import InvalidRequirement, Requirement

from analytic.problem.errors import InputError, unknown
from engines.engine import Engine, Role
from engines.known import LISTED, known_engines, own_version


@dataclass(frozen=True)
class Found:
    """An engine by name, whether or not it can be used here.

    Attributes
    ----------
    name : str
        What ``--engine`` calls it.
    engine : Engine or None
        None if its module cannot be imported.
    version : str or None
        Of the distribution that offers it or, if it is shipped here, of the one that it needs; None
        if that is not installed.
    trouble : str or None
        Why it cannot be used, and what to do; None if it can.
    role : str
        What its difference from MuJoCo says; empty if there is no engine.
    tuned : str
        What was set for it, as it says itself; empty if it does not.
    """

    name: str
    engine: Engine | None
    version: str | None
    trouble: str | None
    role: Role | Literal[""] = ""
    tuned: str = ""


def list_engines() -> list[Found]:
    """All engines that are known here, the shipped ones first.

    Returns
    -------
    list of Found
        A name each; an entry point cannot take the name of a shipped engine.
    """
    return [_found(name, target) for name, target in known_engines().items()]


def find_engine(name: str) -> Engine:
    """The engine of that name, ready for use.

    Parameters
    ----------
    name : str
        As `list_engines` has it.

    Returns
    -------
    Engine
        That can be asked for a sweep.

    Raises
    ------
    InputError
        If there is none, or what it needs is missing or of the wrong version.
    """
    known = known_engines()
    if name not in known:
        raise unknown("engine", name, known, remedy=LISTED)
    found = _found(name, known[name])
    if found.engine is None or found.trouble is not None:
        raise InputError("engine", repr(name), "installed", found.trouble or "install it")
    return found.engine


def _found(name: str, target: str) -> Found:
    module, _, attribute = target.partition(":")
    try:
        engine: Engine = getattr(import_module(module), attribute)
        role, requires, tuned = _said(engine)
    except (Exception, SystemExit) as error:  # whatever another's module does when imported
        what = " ".join(f"{type(error).__name__}: {error}".split())
        return Found(name, None, None, f"{target} cannot be loaded ({what})")
    own = own_version(name)
    there, trouble = installed(requires) if requires else (own, None)
    return Found(name, engine, there and (own or there), trouble, role, tuned)


def _said(engine: Any) -> tuple[Role, str, str]:  # noqa: ANN401  # whatever is offered
    """What an engine says of itself; raise if it is none, so that only itself is lost by that."""
    if isinstance(engine, type):
        raise TypeError(f"an engine is an object, as {engine.__name__}(), and no class")
    if not callable(getattr(engine, "sweep", None)):
        raise TypeError(f"{type(engine).__name__} has no method sweep(case, settings, advance)")
    for given in ("case, settings", "case, settings, advance"):
        try:
            signature(engine.sweep).bind(*given.split(", "))
        except TypeError as error:
            raise TypeError(f"sweep({given}) cannot be called: {error}") from None
    role: Role = getattr(engine, "role", "other model")
    requires, tuned = getattr(engine, "requires", ""), getattr(engine, "tuned", "")
    if role not in get_args(Role):
        raise ValueError(f"role is {role!r}, not one of {', '.join(get_args(Role))}")
    if not isinstance(tuned, str):
        raise TypeError(f"tuned is {tuned!r}, no text")
    try:
        Requirement(requires or "any")
    except (InvalidRequirement, TypeError) as error:
        raise ValueError(f"requires is {requires!r}, no requirement of pip's: {error}") from None
    return role, requires, tuned


def installed(requires: str) -> tuple[str | None, str | None]:
    needed = Requirement(requires)
    try:
        there = version(needed.name)
    except PackageNotFoundError:
        return None, f"{needed.name} is not installed: pip install '{requires}'"
    if needed.specifier.contains(there, prereleases=True):
        return there, None
    return there, f"{needed.name} {there} is not {needed.specifier}: pip install '{requires}'"
