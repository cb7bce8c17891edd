"""How far two sweeps may disagree, with the reason for every limit."""

from dataclasses import dataclass, fields


class Limit(float):
    """A number that carries the reason for its size."""

    reason: str

    def __new__(cls, value: float, reason: str = "asked for by the caller") -> "Limit":
        """A float with its reason."""
        limit = super().__new__(cls, value)
        limit.reason = reason
        return limit


@dataclass(frozen=True)
class Tolerances:
    """Limits of agreement; the defaults are for a chain of 40 segments against the closed form.

    A second-order beam of N segments is off by about 3/N^2 where the contact bends half of it, and
    a fine mesh's facets add less than that. Each carries its reason.
    """

    rms: float = Limit(
        2e-3,
        "Of each clamp reading over all compared stations, relative to its largest magnitude: "
        "a beam of 40 segments is off by about 3/N^2.",
    )
    max: float = Limit(
        2e-2,
        "The same at any one station: ten times the rms, for the stations where the contact passes "
        "from segment to segment and where a transition falls between two stations.",
    )
    snap_off_window: float = Limit(
        5e-3,
        "Stretch before snap-off, of the sweep's length, where max is not asked: the readings grow "
        "like a square root there, so an error of the fold's place turns into any error of theirs.",
    )
    phase_agreement: float = Limit(
        0.99,
        "Share of stations whose phase, judged from the clamp, is the true contact's: two of 200 "
        "may fall between the two models' transitions.",
    )
    transition: float = Limit(
        1e-2,
        "Of each transition's place, in L: less than half a station of the default sweep.",
    )
    snap_off: float = Limit(
        3e-3,
        "Of the snap-off's place, in L: the rms limit times the foot's travel in the last phase.",
    )
    untrusted: float = Limit(
        5e-3, "Share of the candidate's stations that may have failed to settle."
    )

    def of_sweep(self, reading: str) -> Limit:
        """The limit of a reading's rms over all phases."""
        return self.limits()["rms"]

    def limits(self) -> dict[str, Limit]:
        """All limits by name."""
        named = {f.name: getattr(self, f.name) for f in fields(self)}
        return {name: x if isinstance(x, Limit) else Limit(x) for name, x in named.items()}
