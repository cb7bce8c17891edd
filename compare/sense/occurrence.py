"""Where something happens in two sweeps."""

from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class Occurrence:
    """Where along both sweeps something happens; None where it does not."""

    reference: float | None
    candidate: float | None
    uncertainty: float = 0.0

    @property
    def difference(self) -> float | None:
        """Candidate less reference."""
        if self.reference is None or self.candidate is None:
            return None
        return self.candidate - self.reference

    def agrees(self, tolerance: float) -> bool:
        """Whether it happens in neither sweep, or at nearly the same place in both."""
        if self.difference is None:
            return self.reference is None and self.candidate is None
        return abs(self.difference) <= tolerance + self.uncertainty

    def to_dict(self) -> dict[str, float | None]:
        return {**asdict(self), "difference": self.difference}
