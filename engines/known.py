"""The names of the engines: of those shipped here, and of other distributions' by entry points."""

from collections.abc import Iterator
from importlib.metadata import EntryPoint, entry_points

from analytic.problem.errors import InputError, near

GROUP = "vibrissa.engines"
"""The entry points by which other distributions offer engines: ``name = "module:ENGINE"``."""
_SHIPPED = {
    "mujoco": "engines.mujoco:ENGINE",
    "drake": "engines.shipped:DRAKE",
    "exudyn": "engines.shipped:EXUDYN",
    "pinocchio": "engines.shipped:PINOCCHIO",
    "dart": "engines.shipped:DART",
    "pyelastica": "engines.shipped:PYELASTICA",
}

LISTED = "`vibrissa list engines` lists them; your own needs an entry point of vibrissa.engines"


def named_engines(names: str) -> list[str]:
    listed = [name.strip() for name in names.split(",")]
    if len(set(listed)) == len(listed) and set(listed) <= set(_SHIPPED):
        return listed  # nothing in them is worth a look at every distribution that is installed
    known = known_engines()
    if len(set(listed)) < len(listed) or not set(listed) <= set(known):
        allowed = f"names between commas, each once, of {', '.join(known)}"
        remedy = near(", ".join(name for name in listed if name not in known), known, LISTED)
        raise InputError("engine", repr(names), allowed, remedy)
    return listed


def known_engines() -> dict[str, str]:
    offered = {point.name: point.value for point in sorted(_offered(), key=lambda p: p.value)}
    return {**_SHIPPED, **{n: where for n, where in offered.items() if n not in _SHIPPED}}


def own_version(name: str) -> str | None:
    """Of the distribution that offers an engine by an entry point."""
    offered = (point.dist for point in _offered() if point.name == name not in _SHIPPED)
    return next((dist.version for dist in offered if dist is not None), None)


def _offered() -> Iterator[EntryPoint]:
    yield from entry_points(group=GROUP)
