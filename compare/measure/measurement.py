"""Two sweeps set side by side: how far apart, where, and in which phase."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pandas as pd

from analytic import InputError, Readings
from analytic.from_clamp.noise import SIGMAS
from compare.align.offset import (
    NoOffsetError,
    Offset,
    checked_offset,
    estimate_offset,
    without_offset,
)
from compare.align.order import RowOrder, in_order
from compare.align.stations import Alignment, align, check_same_way
from compare.align.units import check_unit_of_length, in_units_of
from compare.measure.disagreement import SweepPair, at_rest, disagreements
from compare.sense.noise import scales
from compare.sense.occurrence import Occurrence
from compare.sense.phases import Classification, classify, confusion
from compare.sense.record import Record, check_size, inspect_record
from compare.sense.transitions import (
    TRANSITIONS,
    locate_transitions,
    second_contacts,
    shows_beyond,
    snap_off,
)


@dataclass(frozen=True, eq=False, repr=False)
class Measurement(SweepPair[Readings]):
    """What two sweeps differ by, before anyone judges it.

    The candidate's rows are in the order of the motion, its ``foot_x`` without the offset. Events
    are ``first_contact``, ``phase_b_start``, ``phase_b_end`` and ``snap_off``; where a sweep has a
    second contact, and both look for one, ``second_contact_start`` and ``.._end`` besides.
    """

    alignment: Alignment  # the compared stations, and why the others are not
    judged: dict[str, Classification]  # the phases that the clamp readings show, of either sweep
    confusion: dict[str, pd.DataFrame]  # those against the contact truth, where it is recorded
    offset: Offset  # what was taken from the candidate's foot_x before anything else
    records: dict[str, Record]  # defects of either sweep's record
    order: RowOrder  # how the candidate's rows follow the motion

    @property
    def transitions(self) -> dict[str, Occurrence]:
        return {name: event for name, event in self.events.items() if name != "snap_off"}

    @property
    def snap_off(self) -> Occurrence:
        return self.events["snap_off"]

    def phase_agreement(self) -> dict[str, float]:
        """Fraction of stations judged rightly, of each sweep that recorded the contact."""
        return {
            which: float(np.trace(table) / table.to_numpy().sum())
            for which, table in self.confusion.items()
            if table.to_numpy().sum()
        }

    def phases_alike(self) -> float | None:
        """Fraction of stations judged as the reference there; None if neither touches anywhere."""
        counts, table = self.alignment.counts, self.alignment.table
        judged = self.judged["candidate"].phase[table["station"].to_numpy()]
        alike = counts["free"] + int((judged == table["phase"].to_numpy()).sum())
        touching = counts["one_free"] + counts["compared"]
        return alike / (counts["free"] + touching) if touching else None

    def beyond(self) -> list[str]:
        """Events on the stretch of the reference, beyond the one that the candidate covers."""
        return [
            name
            for name, has, lacks, at in self._one_sided()
            if has == "reference" and self._covers(has, at) and not self._covers(lacks, at)
        ]

    def not_reached(self) -> list[str]:
        """Events of one sweep beyond the stations of both: known, but asked of neither."""
        return [
            name
            for name, has, lacks, at in self._one_sided()
            if not (self._covers(has, at) or self._covers(lacks, at))
        ]

    def cut_off(self) -> Iterator[tuple[float, float, int]]:
        """Where the candidate's stations end amid the reference's contact.

        The last place, how far the reference touches, and how many rows lie between.
        """
        phase, at = self.judged["reference"].phase, self.reference.running_values
        touching = at[(phase != "free") & (phase != "")]
        own = np.unique(self.candidate.running_values)
        steps = np.diff(own if len(own) > 1 else np.unique(at))
        if not touching.size or not steps.size:
            return
        step = float(np.median(steps))
        for far, way in ((touching.min(), -1), (touching.max(), 1)):
            end, last = own[::way][-1], own[::way][-2:]
            beyond = way * (far - end)
            if beyond > max(step, float(np.ptp(last))) + abs(self.offset.value):
                yield float(end), float(far), round(beyond / step)

    def _covers(self, which: str, at: float) -> bool:
        along = getattr(self, which).running_values
        return bool(along.min() <= at <= along.max())

    def unsure(self) -> list[str]:
        """Limits of a Phase B that one sweep alone has.

        As far as its noise lets the phases on both sides be seen, or where the other one has no
        station during it.
        """
        found = []
        for name, has, lacks, place in self._one_sided():
            if not name.startswith("phase_b"):
                continue
            judged, along = self.judged[has], getattr(self, has).running_values
            here = judged.phase == "tangent"
            sure = judged.shortfall[here] > SIGMAS * judged.shortfall_tolerance[here]
            way = np.sign(along[-1] - along[0]) * (1 if name == "phase_b_end" else -1)
            beyond = (judged.phase == "tip") & (way * (along - place) > 0)
            oblique = np.abs(judged.criterion) > SIGMAS * judged.criterion_tolerance
            during, theirs = along[here], getattr(self, lacks).running_values
            met = ((during.min() <= theirs) & (theirs <= during.max())).any()
            found += [] if sure.any() and oblique[beyond].any() and met else [name]
        return found

    def not_trusted(self) -> list[str]:
        """Events that one sweep lacks where its stations are not to be trusted."""
        found = []
        for name, _, lacks, at in self._one_sided():
            sweep = self.reference if lacks == "reference" else self.candidate
            nearest = np.argmin(np.abs(sweep.running_values - at))
            found += [] if sweep.trusted[nearest] else [name]
        return found

    def _one_sided(self) -> Iterator[tuple[str, str, str, float]]:
        """The events that one sweep alone has: which has it, which lacks it, and where it is."""
        for name, event in self.events.items():
            if event.candidate is None and event.reference is not None:
                yield name, "reference", "candidate", event.reference
            if event.reference is None and event.candidate is not None:
                yield name, "candidate", "reference", event.candidate

    def __repr__(self) -> str:
        far = ", ".join(f"{name} {d.rms:.1e}" for name, d in self.disagreement.items())
        return (
            f"{type(self).__name__}({self.candidate.source} against {self.reference.source}: {far})"
        )


def measure(
    reference: Readings, candidate: Readings, window: float, offset: float | Literal["auto"] = 0.0
) -> Measurement:
    """Measure how far `candidate` is from `reference`, from their readings alone."""
    for which, sweep in (("reference", reference), ("candidate", candidate)):
        check_size(which, sweep)
    check_same_way(reference, candidate)
    if offset != 0:
        reference.require_sweep("an offset")
    scales(reference)
    records = {"reference": inspect_record(reference)}
    if records["reference"].retreats:
        what = next(records["reference"].defects())
        allowed = "in the order of the motion"
        remedy = f"sort them by {reference.running}, or compare one sweep at a time"
        raise InputError(f"rows of the reference ({reference.source})", what, allowed, remedy)
    candidate = _held_alike(reference, candidate)
    candidate, records["candidate"], order = in_order(reference, candidate)
    judged = {"reference": classify(reference), "candidate": classify(candidate)}
    comparable = in_units_of(reference, candidate)
    check_unit_of_length(reference, comparable, judged["reference"])
    if offset == "auto" and not order.opposite:
        of_units = judged["candidate"] if comparable is candidate else classify(comparable)
        try:
            shift = estimate_offset(reference, comparable, judged["reference"], of_units)
        except NoOffsetError as why:
            shift = Offset(0.0, unknown=str(why))
    else:  # a sweep the other way has no offset to this one
        shift = Offset(0.0 if offset == "auto" else checked_offset(offset))
    candidate = without_offset(candidate, shift.value)
    alignment = align(
        reference, candidate, judged["reference"], judged["candidate"], records["candidate"].dropped
    )

    def at(one: tuple[float | None, float], other: tuple[float | None, float]) -> Occurrence:
        return Occurrence(one[0], other[0], one[1] + other[1] + shift.uncertainty)

    sweeps: Mapping[str, Readings] = {"reference": reference, "candidate": candidate}
    snap = at(*(snap_off(sweep, judged[which]) for which, sweep in sweeps.items()))
    one, other = (dict(locate_transitions(sweep, judged[which])) for which, sweep in sweeps.items())
    for name in ("phase_b_start", "phase_b_end"):
        for mine, theirs in ((one, other), (other, one)):
            place, off = mine[name]
            if place is not None and theirs[name][0] is None:
                seen = (shows_beyond(name, place, off, sweeps[i], judged[i]) for i in sweeps)
                mine[name] = mine[name] if all(seen) else theirs[name]
    events = {name: at(one[name], other[name]) for name in TRANSITIONS}
    twice = second_contacts(reference), second_contacts(candidate)
    if twice[0] and twice[1]:
        seconds = {
            name: at(twice[0][name], twice[1][name]) for name in twice[0] if name in twice[1]
        }
        events |= {
            name: one for name, one in seconds.items() if not one.reference is one.candidate is None
        }
    idle = at_rest(candidate, alignment.idle, snap)
    return Measurement(
        reference,
        candidate,
        disagreements(reference, alignment.table, snap, window, idle),
        {**events, "snap_off": snap},
        alignment,
        judged,
        {
            which: confusion(judged[which], sweep)
            for which, sweep in sweeps.items()
            if "phase" in sweep.table
        },
        shift,
        records,
        order,
    )


def _held_alike(reference: Readings, candidate: Readings) -> Readings:
    """The candidate, in the clamp and with the friction of the reference if it does not say.

    A sweep that an engine made of a case says it: its provenance has the case's digest.
    """
    support = reference.provenance.get("support")
    if support is None or {"support", "digest"} & candidate.provenance.keys():
        return candidate
    return replace(candidate, provenance={**candidate.provenance, "support": support})
