"""Which engines there are, and whether they can be used here."""

from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import get_args

from packaging.requirements import InvalidRequirement, Requirement

from analytic.problem.errors import InputError, unknown
from engines.engine import Engine, Role
from engines.known import known_engines, own_version


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
    """

    name: str
    engine: Engine | None
    version: str | None
    trouble: str | None


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
        raise unknown("engine", name, known, remedy="`vibrissa list engines` lists them")
    found = _found(name, known[name])
    if found.engine is None or found.trouble is not None:
        raise InputError("engine", repr(name), "installed", found.trouble or "install it")
    return found.engine


def _found(name: str, target: str) -> Found:
    module, _, attribute = target.partition(":")
    try:
        engine: Engine = getattr(import_module(module), attribute)
        Requirement(engine.requires)
        _check(engine)
    except (Exception, SystemExit) as error:  # whatever another's module does when imported
        what = " ".join(f"{type(error).__name__}: {error}".split())
        if isinstance(error, InvalidRequirement):
            what = f"its requirement cannot be read: {what}"
        return Found(name, None, None, f"{target} cannot be loaded ({what})")
    there, trouble = installed(engine.requires)
    return Found(name, engine, there and (own_version(name) or there), trouble)


def _check(engine: Engine) -> None:
    """Raise if it lacks what an engine is asked for, so that only itself is lost by that."""
    if engine.role not in get_args(Role):
        raise ValueError(f"role is {engine.role!r}, not one of {', '.join(get_args(Role))}")
    if not callable(engine.sweep):
        raise TypeError("sweep is no function")
    if not isinstance(engine.tuned, str):
        raise TypeError("tuned is no text")


def installed(requires: str) -> tuple[str | None, str | None]:
    needed = Requirement(requires)
    try:
        there = version(needed.name)
    except PackageNotFoundError:
        return None, f"{needed.name} is not installed: pip install '{requires}'"
    if needed.specifier.contains(there, prereleases=True):
        return there, None
    return there, f"{needed.name} {there} is not {needed.specifier}: pip install '{requires}'"
