"""A disagreement split by other engines: what of it is implementation, and what is the model.

MuJoCo's disagreement with the exact solution is the sum of two differences: MuJoCo from a twin,
which computes the same discrete model, and the twin from the exact solution. The first is
implementation, of whichever of the two; the second is the model's. An engine with a discretisation
of its own shows what another model of the same rod does.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from analytic import CLAMP_READINGS, Readings
from compare.judge.tolerances import Tolerances
from compare.measure.measurement import Measurement, measure

ROUNDING = 1e-7
"""Relative rms below which twins are equal: a rest to 1e-8 EI/L in either leaves 1e-9 to 1e-8."""


@dataclass(frozen=True)
class Split:
    subject: str  # names of the engines
    twin: str
    # Relative rms of each clamp reading: subject from exact, subject from twin, twin from exact.
    disagreement: dict[str, float]
    implementation: dict[str, float]
    model: dict[str, float]
    # The same of each other model from the exact solution, by engine and reading.
    others: dict[str, dict[str, float]]
    snap_off: float | None  # of the subject less that of the twin [L]

    @property
    def blame(self) -> str:
        """Where most of the disagreement is: ``"implementation"`` or ``"model"``.

        Of the reading whose implementation has the largest share of its disagreement.
        """
        return "implementation" if self.share > 0.5 else "model"

    @property
    def share(self) -> float:
        """The implementation's largest share of a reading's disagreement; 0 below rounding."""
        shown = {name: x for name, x in self.implementation.items() if x > ROUNDING}
        whole = {name: max(self.disagreement[name], self.model[name]) for name in shown}
        return max((x / whole[name] for name, x in shown.items()), default=0.0)

    @property
    def sentence(self) -> str:
        worst = max(self.implementation.values())
        apart = f"{self.subject} and its twin {self.twin} are {worst:.1e} apart"
        if worst <= ROUNDING:
            return (
                f"{apart}: {self.subject} computes this model right, and its disagreement of "
                f"{max(self.disagreement.values()):.1e} is the model's."
            )
        if self.blame == "model":
            return (
                f"{apart}, {self.share:.0%} of the disagreement: most of it is the model's, some "
                "of it one of the two implementations'."
            )
        return (
            f"{apart}, {self.share:.0%} of the disagreement: {self.subject} or {self.twin} does "
            "not compute the model that was asked for."
        )

    def parts(self) -> dict[str, dict[str, float]]:
        """Relative rms of each reading, by what it is of."""
        subject, twin = self.subject, self.twin
        return {
            f"{subject} against exact": self.disagreement,
            f"implementation: {subject} against {twin}": self.implementation,
            f"model: {twin} against exact": self.model,
            **{f"other model: {name} against exact": rms for name, rms in self.others.items()},
        }

    def to_dict(self) -> dict[str, Any]:
        return {**asdict(self), "blame": self.blame, "sentence": self.sentence}


def split(
    exact: Readings, sweeps: Mapping[str, Readings], roles: Mapping[str, str]
) -> Split | None:
    by_role = {roles[name]: name for name in reversed(list(sweeps))}
    if "subject" not in by_role or "twin" not in by_role:
        return None
    subject, twin = by_role["subject"], by_role["twin"]
    window = Tolerances.snap_off_window
    between = measure(sweeps[twin], sweeps[subject], window)
    off = {name: _rms(measure(exact, one, window)) for name, one in sweeps.items()}
    disagreement, model = off.pop(subject), off.pop(twin)
    apart = between.snap_off.difference
    snap_off = None if apart is None else apart / exact.beam.length
    others = {n: rms for n, rms in off.items() if all(map(math.isfinite, rms.values()))}
    return Split(subject, twin, disagreement, _rms(between), model, others, snap_off)


def _rms(found: Measurement) -> dict[str, float]:
    return {name: found.disagreement[name].rms for name in CLAMP_READINGS}
