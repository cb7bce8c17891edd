"""How far a rig's readings lag behind its foot, for people and in the files of its passes."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace

import numpy as np

from analytic import Beam, Readings
from analytic.from_clamp.object.lag import Lag
from compare.read.passes import Pass
from compare.show.document import Text
from compare.show.numbers import quantity

_LAG = "lag"  # in the provenance of a pass
_OFF = 0.02  # of the rigidity; less is within what most vibrissae are known to


def lag_summary(passes: Sequence[Pass], found: Lag | None, taken: float) -> Iterator[Text]:
    """What passes in both directions say, and what to do about it; nothing of one direction.

    A lag that the rig's description states was taken off already.
    """
    if len({one.direction for one in passes}) < 2:
        return
    if found is None:
        yield Text(
            "whether readings lag behind the foot is not known: no convex contour explains the "
            "passes in both directions (several objects, friction, a zero that is not taken off?)"
        )
        return
    beam = passes[0].readings.beam
    said = _lag_of(asdict(found)["way"], beam)
    if not found.shows:
        yield Text(f"no lag of the readings shows: {said}, by passes in both directions")
    else:
        ways = found.way.value, found.way.lowest, found.way.highest
        speeds = [x for one in passes if (x := one.readings.provenance.get("speed"))]
        if speeds:
            speed = float(np.median(speeds))
            late, least, most = (1e3 * way / speed for way in ways)
            in_time = f"{late:.3g} ms (95 %: {least:.3g} to {most:.3g} ms)"
            said = f"{in_time} at {quantity(speed, 'length', beam)}/s" if beam.si else said
        which = "after" if found.way.value > 0 else "before"
        in_all = ways[0] + taken
        stated = f'"{1e3 * in_all:.4g} mm"' if beam.si else f"{in_all:.4g}"
        yield Text(f"the readings come {which} the positions: {said}")
        yield Text(
            "  a stage's play or friction looks alike, an offset does not; passes at another speed "
            f"show which it is. To take it off, write under [passes]: lag = {stated}"
        )
    if abs(found.rigidity.value - 1) > _OFF:
        yield Text(f"  the passes fit a vibrissa of {found.rigidity.value:.3g} times [beam]'s EI")


def with_lag(readings: Readings, found: Lag) -> Readings:
    """A pass that remembers the lag."""
    return replace(readings, provenance={**readings.provenance, _LAG: asdict(found.way)})


def lag_remembered(passes: Sequence[Readings]) -> str | None:
    """What to say of the lag that a rig's passes have, if they are in both directions."""
    known = [x for one in passes if (x := one.provenance.get(_LAG))]
    if not known or len({one.runs_right for one in passes}) < 2:
        return None
    if known[0]["lowest"] <= 0 <= known[0]["highest"]:
        return None
    which = "after" if known[0]["value"] > 0 else "before"
    said = _lag_of(known[0], passes[0].beam)
    return f"the readings come {which} the positions, as `rig` said: {said}"


def _lag_of(way: dict[str, float], beam: Beam) -> str:
    lowest, highest = (quantity(way[end], "length", beam) for end in ("lowest", "highest"))
    return f"{quantity(way['value'], 'length', beam)} (95 %: {lowest} to {highest})"
