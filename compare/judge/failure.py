"""A limit that is exceeded, in sentences that say where, by how much and why so."""

import math
from dataclasses import dataclass

from compare.judge.tolerances import Limit


@dataclass(frozen=True)
class Failure:
    """One limit that is exceeded."""

    name: str  # the reading, event or part of the record that it is about
    found: str  # what was found, with its number
    # The same as part of a sentence: what is wrong, with its number and what is allowed.
    clause: str
    allowed: str  # what is allowed, with the reason
    excess: float = math.inf  # how many times what is allowed; infinite for what must not be at all

    def __str__(self) -> str:
        """The whole sentence."""
        return f"{self.name}: {self.found}; {self.allowed}"


def allowed(limit: Limit, noise: float = 0.0, unit: str = "") -> str:
    """What is allowed, with the reason."""
    return f"allowed {float(limit):.2e}{unit}{_beside(noise, unit)} ({limit.reason})"


def where_allowed(limit: Limit, noise: float = 0.0, unit: str = "") -> str:
    """What is allowed, as the end of a sentence on what was found."""
    return f" where {float(limit):.1e}{unit} is allowed{_beside(noise, unit)}"


def excess(found: float, limit: float) -> float:
    """How many times what is allowed."""
    return float(found / limit) if limit > 0 else math.inf


def plus_minus(uncertainty: float, unit: str = "") -> str:
    """The uncertainty behind a number, if there is one."""
    return f" +- {uncertainty:.1e}{unit}" if uncertainty else ""


def _beside(noise: float, unit: str) -> str:
    return f" beside noise of {noise:.1e}{unit}" if noise else ""
