"""A measurement that was judged: its verdict, and what is kept of it."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any, TypeAlias

import numpy as np
from pydantic_core import to_jsonable_python

from compare.judge.allowance import Allowance
from compare.judge.failures import Failure, untrusted_stretches
from compare.judge.rate import Rate
from compare.judge.tolerances import CONVENTION, Limits
from compare.measure.disagreement import Sweep, SweepPair, rms
from compare.sense.occurrence import Occurrence

Number: TypeAlias = float | int | bool | None

_SHOWN = 6  # failures in the short form
_SLENDER = 0.05  # strain; at more, neither theory nor a chain of hinges is a vibrissa's
_FEW = 10  # stations
_BLURS = 0.5  # of a limit; less that means over wide stations are off is not what exceeds it
_SHARP = 0.1  # of a limit, that they may be off by with a smaller window


@dataclass(frozen=True, eq=False, repr=False)
class Judged(SweepPair[Sweep]):
    """A comparison of n components along a travel; the plane and space each add their own."""

    tolerances: Limits  # for the verdict
    noise: Allowance  # what noise adds to them

    def _failures(self) -> Iterator[Failure]:
        raise NotImplementedError

    def _own(self) -> dict[str, Any]:
        """What ``comparison.json`` holds beside what all comparisons have."""
        raise NotImplementedError

    def _own_metrics(self) -> dict[str, Number]:
        raise NotImplementedError

    def _places(self) -> Mapping[str, Occurrence | None]:
        """The events of the metrics, by name; None for one that is in neither sweep."""
        raise NotImplementedError

    def _beside(self) -> Iterator[str]:
        """Lines on what else is compared than the components."""
        yield from ()

    def lines(self) -> Iterator[str]:
        """The verdict, the disagreement of each component, and what failed, for a terminal."""
        size, unit = self.reference.running_unit
        yield (
            f"{self.candidate.source} {'agrees' if self.agrees else 'disagrees'} with "
            f"{self.reference.source}; compared at {self.stations} of "
            f"{len(self.candidate.table)} stations"
        )
        if self.why:
            yield f"  {self.why}"
        for name, one in self.disagreement.items():
            limit = self.tolerances.of(name, "rms")
            if one.stations:
                yield f"  {name:9} rms {one.rms:.1e}  max {one.max:.1e}  allowed {limit:.1e} rms"
        yield from self._beside()
        for name, event in self.events.items():
            if event.candidate is not None and event.difference is not None:
                at, apart = event.candidate / size, event.difference / size
                yield f"  {name:13} at {at:.5g} {unit}, {apart:+.1e} {unit} apart"
        for failure in self.exceeded[:_SHOWN]:
            yield f"  failed: {failure.clause}"
        if len(self.exceeded) > _SHOWN:
            yield f"  and {len(self.exceeded) - _SHOWN} more, see .failures"
        yield from (f"  {remark}" for remark in self.remarks)

    @cached_property
    def exceeded(self) -> tuple[Failure, ...]:
        return tuple(self._failures())

    @property
    def failures(self) -> tuple[str, ...]:
        """Every limit that is exceeded, in a sentence each."""
        return tuple(str(failure) for failure in self.exceeded)

    @property
    def worst(self) -> Failure | None:
        """What leads the verdict: of the failures of most weight that of the largest excess."""
        return max(self.exceeded, key=lambda one: (one.weight, one.excess), default=None)

    def __bool__(self) -> bool:
        # Any object is true: `assert compare(...)` held whatever was found.
        raise TypeError(
            "a comparison is neither true nor false: take `.agrees`, or assert_agreement"
        )

    @property
    def agrees(self) -> bool:
        """Whether no limit is exceeded."""
        return not self.exceeded

    @property
    def likely(self) -> str | None:
        """What the disagreement looks like; None if it agrees, or matches no known cause."""
        return None

    @property
    def why(self) -> str:
        """What a disagreement is likely made of, if that is known."""
        return "" if self.likely is None else f"likely: {self.likely}"

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is to be known of both sweeps, and of the limits that are exceeded."""
        failed = " ".join(self.failures)
        unknown, own = map(list, map(untrusted_stretches, (self.reference, self.candidate)))
        beside = [stretch for stretch in own if stretch not in failed and stretch not in unknown]
        notes: list[str] = [
            f"note: not all stations of the {which} are compared: {stretch}"
            for which, stretches in (("reference", unknown), ("candidate", beside))
            for stretch in stretches
        ]
        if self.exceeded and self.tolerances.conventional:
            notes.append(CONVENTION)
        notes += self._blurred()
        if self.agrees and self.stations < _FEW:
            notes.append(f"note: so few stations show little: {self.stations}")
        if self.strain > _SLENDER:
            notes.append(
                f"note: the vibrissa bends to a strain of {self.strain:.0%}; the elastica is of "
                f"small ones, up to {_SLENDER:.0%}"
            )
        return tuple(notes)

    def _blurred(self) -> Iterator[str]:
        """That means over the way between stations are not what is read in its middle.

        By h^2 f''/24, of which the reference's stations show what they can.
        """
        rate = Rate.of(self.candidate)
        if rate is None or not self.exceeded:
            return
        step, own = (
            float(np.median(np.abs(np.diff(side.running_values))))
            for side in (self.reference, self.candidate)
        )
        off = {}
        for name, one in self.disagreement.items():
            read = self.reference.values(name)
            bends = np.diff(read[np.isfinite(read) & (read != 0)], 2) / 24 / one.scale
            off[name] = float(rms(bends)) * (rate.average * own / step) ** 2
        shares = {name: off[name] / self.tolerances.of(name, "rms") for name in off}
        worst = max(shares, key=lambda name: np.nan_to_num(shares[name]))
        if shares[worst] > _BLURS:
            less = rate.average * math.sqrt(_SHARP / shares[worst])
            yield (
                f"note: in motion each reading is a mean over the way between stations, which so "
                f"far apart makes {worst} some {off[worst]:.1e} of its largest magnitude wrong; "
                f"take more stations, or `[motion] average = {less:.1g}`"
            )

    @property
    def strain(self) -> float:
        """The largest at the clamp, by the reference."""
        moments = [one.scale for name, one in self.disagreement.items() if name[0] == "m"]
        beam = self.reference.beam
        return beam.radius * max(moments) / (beam.moment_unit * beam.length)

    @property
    def stations(self) -> int:
        """How many stations the figures rest on."""
        return next(iter(self.disagreement.values())).stations

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds: lengths in the beam's unit, contacts in space in L."""
        limits = self.tolerances.limits()
        found = {
            "verdict": "agrees" if self.agrees else "disagrees",
            "failures": self.failures,
            "noise": self.noise,
            **self._own(),
            "tolerances": limits,
            "tolerance_reasons": {name: limit.reason for name, limit in limits.items()},
            "reference": _origin(self.reference),
            "candidate": _origin(self.candidate),
        }
        plain: dict[str, Any] = to_jsonable_python(found, inf_nan_mode="null")
        return plain

    def metrics(self) -> dict[str, Number]:
        """What a row of a table holds: plain numbers, by component and by event."""
        row: dict[str, Number] = {}
        for name, one in self.disagreement.items():
            row[f"disagreement_{name}_rms"] = one.rms
            row[f"disagreement_{name}_max"] = one.max
        row |= {"agrees": self.agrees, **self._own_metrics()}
        for name, event in self._places().items():
            for part in ("reference", "candidate", "difference"):
                row[f"{name}_{part}"] = None if event is None else getattr(event, part)
        return row

    def __repr__(self) -> str:
        return "\n".join(self.lines())

    def _tiles(self) -> dict[str, object]:
        off = {f"{name} rms": f"{one.rms:.1e}" for name, one in self.disagreement.items()}
        verdict = "agrees" if self.agrees else "disagrees"
        return {"verdict": verdict, **off, "stations": self.stations}

    def _below(self) -> str:
        return "<pre>" + "<br>".join(escape(line) for line in self.lines()) + "</pre>"


def _origin(readings: Sweep) -> dict[str, Any]:
    known = {k: v for k, v in readings.provenance.items() if k not in ("contour", "others")}
    about = {"source": readings.source, "beam": readings.beam}
    return {**about, "stations": len(readings.table), "provenance": known}
