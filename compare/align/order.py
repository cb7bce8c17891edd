"""Rows in the order of the motion, and which way that goes."""

from dataclasses import dataclass, replace

import numpy as np

from analytic import Readings
from compare.sense.record import Record, direction, inspect_record


@dataclass(frozen=True)
class Order:
    """How the candidate's rows follow the motion, seen from the reference.

    Attributes
    ----------
    reversed : bool
        The rows run against the reference's, while force and moment have its signs: the last
        station comes first.
    sorted : bool
        The rows are in no order of a motion.
    opposite : bool
        The foot moves the other way: rows and ``moment_z`` both have the other sign.
    """

    reversed: bool = False
    sorted: bool = False
    opposite: bool = False

    @property
    def note(self) -> str | None:
        """What is wrong with the rows, and what was compared instead; None if nothing is."""
        if self.reversed:
            return (
                "rows reversed: foot_x runs the other way than in the reference while force and "
                "moment have its signs; compared from the last row to the first"
            )
        if self.sorted:
            return (
                "rows out of order: foot_x leads back and forth; compared after sorting by foot_x, "
                "in the direction that the signs of force and moment show"
            )
        return None


def in_order(reference: Readings, candidate: Readings) -> tuple[Readings, Record, Order]:
    """The candidate with its rows in the order of the motion, and what was wrong with them.

    The vibrissa bends against the foot's motion, so that a sweep in the opposite direction has a
    ``moment_z`` of the opposite sign as well. That distinguishes it from a file whose rows are
    reversed, and both from a sensor that is wired the wrong way, where the rows run as in the
    reference.

    Parameters
    ----------
    reference, candidate : Readings
        Two sweeps.

    Returns
    -------
    candidate : Readings
        The same object, if its rows are in order.
    record : Record
        Its defects, row by row in that order.
    order : Order
        What was found.
    """
    record = inspect_record(candidate)
    turned = _sign(candidate, "moment_z") * _sign(reference, "moment_z") < 0
    if record.retreats:
        # A sweep the other way has the sign of force_y; a sensor that is turned has not.
        turned &= _sign(candidate, "force_y") * _sign(reference, "force_y") > 0
        way = -direction(reference) if turned else direction(reference)
        sorted_ = _taken(candidate, np.argsort(way * candidate.values("foot_x"), kind="stable"))
        again = replace(inspect_record(sorted_), retreats=record.retreats)
        return sorted_, again, Order(sorted=True, opposite=turned)
    if direction(candidate) * direction(reference) > 0:
        return candidate, record, Order()
    if turned:
        return candidate, record, Order(opposite=True)
    turned_round = _taken(candidate, np.arange(len(candidate.table))[::-1])
    return turned_round, inspect_record(turned_round), Order(reversed=True)


def _taken(readings: Readings, rows: np.ndarray) -> Readings:
    return replace(readings, table=readings.table.iloc[rows].reset_index(drop=True))


def _sign(readings: Readings, name: str) -> float:
    values = readings.values(name)[readings.trusted]
    return float(np.sign(np.sum(values)))
