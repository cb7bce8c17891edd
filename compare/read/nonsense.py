"""What a pass of a rig cannot be: a contact called free, a stuck channel, a clock that jumps."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from analytic import CLAMP_READINGS, Direction, InputError
from analytic.from_clamp.noise import scatter
from analytic.numerics.arrays import Booleans, Floats
from compare.read.drift import FEWEST
from compare.read.loaded import loaded_from

_SIGMAS = 6.0  # of the noise
_UNITS = 30.0  # times the noise, or the readings, of all three; units differ by more
_DRIFT = 0.25  # of the largest reading; more is no drift of a zero
_STILL = 10  # rows that are equal, at least, while ...
_MOVING = 0.1  # ... another reading changes by this part of its largest one
_OFTEN = 6.0  # times as far as at other levels; a rounded extremum stands still for 4.8 times
_BACK = 0.02  # of the travel, in one step back
_BESIDE = 3  # rows on either side of it
_AHEAD = 0.02  # of the travel, in one step ahead across which ...
_NEAR = 10  # rows on either side
_LEAST_TRAVEL, _MOST_TRAVEL = 1e-4, 1e2  # lengths of the vibrissa; a contact takes 1 or so
_BURST = 3  # rows in a spike, at most
_LEAP = 3.0  # times what three rows before and three behind differ by
_LEAST_LEAP = 0.01  # of the largest reading; less is no harm
_SMOOTH = 0.25  # ... readings change by less than this part of what their slopes say


def check_free(
    which: str, stretch: float, foot_x: Floats, values: Floats, here: Booleans, name: str, si: bool
) -> None:
    """Refuse a stretch that leads into the contact; it begins at the end of the pass."""
    travel = float(np.ptp(foot_x))
    if stretch >= travel:
        what = f"{stretch:g}, of a pass ({name}) of {travel:.4g}"
        remedy = "state a shorter stretch, or check the unit and the gain of foot_x"
        raise InputError(f"passes.{which}", what, "shorter than the pass", remedy)
    order = slice(None, None, -1 if which == "free_after" else 1)
    way = np.abs(foot_x - foot_x[order][0])[order]
    begun = loaded_from(way, values[:, order], here[order])
    if begun is None:
        return
    stated, at, sure = (f"{1e3 * x:.3g} mm" if si else f"{x:.3g}" for x in (stretch, *begun))
    what = f"{stated}, of which {name} is loaded from about {at} on"
    remedy = f"state less than {sure}" if np.sum(way < begun[1]) > FEWEST else "leave it out"
    remedy += ", or begin and end passes farther off"
    raise InputError(f"passes.{which}", what, "free but for drift and noise", remedy)


def check_drift(drift: Floats, values: Floats, name: str) -> None:
    """Refuse two free stretches of which one is not free."""
    for reading, change, row in zip(CLAMP_READINGS, drift, values, strict=True):
        size = float(np.nanmax(np.abs(row), initial=0.0))
        if abs(change) > _DRIFT * size:
            what = f"a drift of {reading} of {name} by {change / size:+.0%} of its largest value"
            allowed = f"at most {_DRIFT:.0%}"
            remedy = (
                "one of them is in contact, or the sensor was reset: look at the pass's picture"
            )
            raise InputError("passes.free_before and free_after", what, allowed, remedy)


def check_object(values: Floats, noise: Floats, way: Direction, name: str, begins: bool) -> None:
    """Refuse a pass without a load, or with that of one the other way, if it begins free."""
    loads = int(np.any(np.abs(values) > _SIGMAS * noise[:, None], axis=0).sum())
    if loads < FEWEST:
        what, remedy = f"under load at {loads} rows", "it touches no object: leave the pass out"
        raise InputError(name, what, f"{_SIGMAS:g} times the noise at {FEWEST} or more", remedy)
    shown = "right" if np.nansum(values[-1]) < 0 else "left"
    if begins and shown != way:
        what = f"to the {way} by foot_x, with the moment of a sweep to the {shown}"
        remedy = "reverse its rows, or change the sign of foot_x or of the readings (gain)"
        raise InputError(name, what, "to one side, in the order of the motion", remedy)


def check_units(values: Floats, stretches: Iterable[Booleans], name: str) -> None:
    """Refuse two free stretches whose noise is of different units."""
    with np.errstate(all="ignore"):  # without noise there is no ratio; too large is refused later
        levels = [np.nanstd(values[:, here], axis=1) for here in stretches]
        ratio = levels[-1] / levels[0]
    if np.all(ratio > _UNITS) or np.all(ratio < 1 / _UNITS):
        what = f"a noise of {name} that changes {ratio[0]:.2g} times between them"
        remedy = "the file has two units, or the amplifier was switched: split it there"
        raise InputError("passes.free_before and free_after", what, "much the same", remedy)


def spikes(values: Floats) -> Booleans:
    """Rows, one to three in turn, at which a reading is far beyond those before and behind."""
    found = np.zeros(values.shape, dtype=bool)
    for row, spiked in zip(values, found, strict=True):
        known = np.flatnonzero(np.isfinite(row))
        while len(known) >= _BURST + 2 * _BESIDE and (leaps := _leaps(row[known])).any():
            spiked[known[leaps]] = True
            known = known[~leaps]  # others may be beside it
    return np.asarray(found.any(axis=0))


def _leaps(row: Floats) -> Booleans:
    """The spikes of which none, or one, is among the rows beside.

    At either end all of these are on one side; there it is to be beyond all of the row, too, as
    what lets go shortly before the end is not.
    """
    row = row / max(float(np.abs(row).max()), np.finfo(float).tiny)  # no difference overflows
    found, order = np.zeros(len(row), dtype=bool), np.sort(row)
    least = max(_SIGMAS * scatter(row), _LEAST_LEAP * np.quantile(np.abs(row), 0.99))
    for burst in range(1, _BURST + 1):
        first = np.arange(len(row) - burst + 1)[:, None]
        begin = np.clip(first - _BESIDE, 0, len(row) - burst - 2 * _BESIDE)
        window = begin + np.arange(burst + 2 * _BESIDE)
        beside = window[(window < first) | (window >= first + burst)].reshape(len(first), -1)
        lowest, highest = np.sort(row[beside], axis=1)[:, [1, -2]].T
        at_end = (begin != first - _BESIDE)[:, 0]
        within = sliding_window_view(row, burst)
        above = within.min(axis=1) - np.where(at_end, order[-1 - burst], highest)
        below = np.where(at_end, order[burst], lowest) - within.max(axis=1)
        clear = np.maximum(_LEAP * (highest - lowest), least)
        found[(first[np.maximum(above, below) > clear] + np.arange(burst)).ravel()] = True
    return found


def check_channels(values: Floats, name: str) -> None:
    """Refuse a channel that stands still while another one moves: it is stuck, or saturates.

    What a coarse converter reads stands still, too, but often.
    """
    largest = np.nanmax(np.abs(values - np.nanmedian(values, axis=1, keepdims=True)), axis=1)
    for i, reading in enumerate(CLAMP_READINGS):
        row = values[i]
        ends = np.flatnonzero(np.append(np.diff(row) != 0, True))
        begins = np.append(0, ends[:-1] + 1)
        others, sizes = np.delete(values, i, axis=0), np.delete(largest, i)
        still = {np.inf: (0.0, 0, 0), -np.inf: (0.0, 0, 0)}  # farthest that others move, by level
        for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
            if end > begin:
                some = others[:, begin : end + 1]
                moved = np.nanmax(some, axis=1) - np.nanmin(some, axis=1)
                np.divide(moved, sizes, out=moved, where=sizes > 0)
                here = float(np.nanmax(moved, initial=0.0)), begin, end
                still[row[begin]] = max(here, still.get(row[begin], here))
        (usual, *_), (most, begin, end) = sorted(still.values())[-2:]
        if end - begin + 1 >= _STILL and most > max(_MOVING, _OFTEN * usual):
            extreme = row[begin] in (np.nanmax(row), np.nanmin(row))
            doing = "saturates" if extreme and np.ptp(row[np.isfinite(row)]) else "is stuck"
            what = f"{row[begin]:g} over {end - begin + 1} rows of {name}: it {doing}"
            allowed = "changing where the other readings do"
            remedy = "leave the pass out, or repeat it within the sensor's range"
            raise InputError(reading, what, allowed, remedy)


def check_travel(foot_x: Floats, length: float, called: str) -> None:
    """Refuse a foot that does not move, or not as a vibrissa of this length is swept."""
    known = foot_x[np.isfinite(foot_x)]
    what = "without any number" if not len(known) else f"{known[0]:g} in all rows"
    if len(known) and (travel := float(np.max(known / length) - np.min(known / length))) > 0:
        if _LEAST_TRAVEL < travel < _MOST_TRAVEL:
            return
        what = f"over {travel:.3g} lengths of the vibrissa"
    allowed = f"a way of {_LEAST_TRAVEL:g} to {_MOST_TRAVEL:g} lengths of it"
    remedy = "check its column, unit and gain, and [beam] length"
    raise InputError(f"foot_x of {called}", what, allowed, remedy)


def check_sizes(each: Sequence[Floats], names: Sequence[str]) -> None:
    """Refuse passes to one side of which some have other units, or another gain."""
    sizes = np.array([np.nanmax(np.abs(values), axis=1, initial=0.0) for values in each])
    shares = sizes / sizes.max(axis=0)
    largest = shares.max(axis=1)
    of_each = np.column_stack([largest, shares / largest[:, None]])
    for called, share in zip(("readings", *CLAMP_READINGS), of_each.T, strict=True):
        least, most = int(np.argmin(share)), names[int(np.argmax(share))]
        if share[least] < 1 / _UNITS:
            what = f"of {names[least]} at most {share[least]:.1e} times as large as of {most}"
            remedy = "of one, units or gain are others: describe its file by a rig.toml of its own"
            raise InputError(called, what, "of much the same size in all passes", remedy)


def check_back(foot_x: Floats, name: str) -> None:
    """Refuse rows whose foot position, or the time that it is from, jumps back and goes on."""
    foot_x = foot_x[np.isfinite(foot_x)]
    steps = np.diff(foot_x)
    way = np.sign(np.median(steps)) if len(steps) else 0.0
    for at in np.flatnonzero(way * steps < -_BACK * np.ptp(foot_x)).tolist():
        before, after = foot_x[max(0, at - _BESIDE) : at + 1], foot_x[at + 1 : at + 2 + _BESIDE]
        # Two rows that are swapped are soon behind; a stage that turns goes on to the other side.
        still = len(before) + len(after) == 2 * _BESIDE + 2 and way * after[-1] < way * before[0]
        if still and np.all(way * np.diff(before) > 0) and np.all(way * np.diff(after) > 0):
            raise _jump(name, at, steps[at], "back")


def check_ahead(foot_x: Floats, values: Floats, name: str) -> None:
    """Refuse a pass in which the foot jumps ahead while the readings go on as if it did not.

    Where one of them does what its slope says, the foot went there, and the others are late.
    """
    known = np.isfinite(values).all(axis=0)
    foot_x, values = foot_x[known], values[:, known]
    steps, travel = np.diff(foot_x), float(np.ptp(foot_x))
    size, noise = np.abs(values).max(axis=1), np.array([scatter(row) for row in values])
    for at in np.flatnonzero(np.abs(steps) > _AHEAD * travel).tolist():
        sides = [slice(max(0, at - _NEAR + 1), at + 1), slice(at + 1, at + 1 + _NEAR)]
        if any(len(foot_x[side]) < _NEAR or np.ptp(foot_x[side]) == 0 for side in sides):
            continue
        lines: Floats = np.array([np.polyfit(foot_x[x], values[:, x].T, 1) for x in sides])
        slopes, heights = lines[:, 0], lines[:, 1]
        expected = np.abs(slopes.mean(axis=0) * steps[at])
        ends = slopes * foot_x[[at, at + 1], None] + heights
        due, changes = expected > _SIGMAS * noise, np.abs(ends[1] - ends[0])
        clear = due & (expected > _MOVING * size)
        follows = (due & (changes > (1 - _SMOOTH) * expected)).any()
        if clear.any() and np.all(changes[clear] < _SMOOTH * expected[clear]) and not follows:
            raise _jump(name, at, steps[at], "ahead, while the readings do not")


def _jump(name: str, row: int, step: float, how: str) -> InputError:
    what = f"a jump by {step:+.4g} after row {row + 1} of {name}, {how}"
    remedy = "the clock or the stage's counter was reset: split the file there, or repeat the pass"
    if how == "back":
        remedy += "; where another pass begins, name the column that changes then, [passes] column"
    return InputError("foot_x", what, "going on in one direction", remedy)
