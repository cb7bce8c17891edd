"""Where in a stretch that is called free the vibrissa is loaded: readings rise or jump there."""

import numpy as np

from analytic.from_clamp.noise import rounding, scatter
from analytic.numerics.arrays import Booleans, Floats

_JUMP = 0.1  # of the largest reading; more is no hum, and no step of a zero ...
_SIGMAS = 6.0  # ... nor noise
_FEWEST = 5  # rows of a level, and behind the stretch
_FEW = 10  # rows: fewer show no noise of their own, and have that of the whole pass
_MOST = 200  # rows among which a rise is looked for: means of more
_STEEP = 0.5  # of the largest reading over the pass: a zero drifts less steeply
_EXACT = 1e-4  # of the largest reading; no noise is taken to be less
_CLEAR = 20.0  # of chi square by which a rise explains more than a drift
_ONSET = 4.0  # of it: within that, 95 %, a rise may begin earlier
_AS_STEEP = 0.4, 3.0  # times the slope behind the stretch: noise that remembers does not go on
_ALONG = 0.8  # cosine between both slopes: one contact loads the readings in one ratio
_ON = 2.0  # times what the stretch rises is reached at three times its length


def loaded_from(way: Floats, values: Floats, here: Booleans) -> tuple[float, float] | None:
    """The way after which a stretch is loaded, and what is surely free; None if all may be.

    The way begins at the end of the pass where the stretch is, and grows.
    """
    known = np.isfinite(values).all(axis=0)
    if (here & known).sum() < _FEWEST:
        return None
    way, values, here = way[known], values[:, known], here[known]
    from_rest = values - np.median(values[:, here], axis=1, keepdims=True)
    size = np.abs(from_rest).max(axis=1, keepdims=True)
    rows = np.divide(from_rest, size, out=np.zeros_like(from_rest), where=size > 0)
    begun = _jump(way, rows, int(here.sum())), _rise(way, rows, here)
    return min((at for at in begun if at is not None), default=None)


def _jump(way: Floats, rows: Floats, count: int) -> tuple[float, float] | None:
    """Where readings jump, as where a contact ends at once."""
    y = rows[:, : count + 1]  # with the row behind, which shows whether the last one is a spike
    level = np.median(y[:, : max(_FEWEST, count // _FEWEST)], axis=1)
    limit = np.maximum(_JUMP, _SIGMAS * np.array([scatter(row) for row in y]))
    among_three = np.median([y[:, :-2], y[:, 1:-1], y[:, 2:]], axis=0)
    beyond = (np.abs(among_three - level[:, None]) > limit[:, None]).any(axis=0)
    at = float(way[np.argmax(beyond)])
    return (at, at) if beyond.any() else None


def _rise(way: Floats, rows: Floats, here: Booleans) -> tuple[float, float] | None:
    """Where readings begin to rise, if that goes on behind the stretch.

    A contact begins at one place for all readings. They rise almost in proportion to the way, and
    go on so in the same ratio. A drift is less steep, and noise does not go on.
    """
    length, steepest = float(way[here].max()), _STEEP / float(np.ptp(way))
    if (~here).sum() < _FEWEST:
        return None
    beside = float(np.sort(way[~here])[_FEWEST - 1]) - length
    behind, further = (~here & (way <= length + max(n * length, beside)) for n in (1, 2))
    parts = np.array_split(np.vstack([way[here], rows[:, here]]), min(_MOST, here.sum()), axis=1)
    x, *others = np.transpose([part.mean(axis=1) for part in parts])
    y = np.array(others)
    exact = _EXACT**2 + np.square([[rounding(row)] for row in rows])
    drift = np.clip(_fitted(x[None], y)[0], -steepest, steepest)
    free = np.var(y - drift * x, axis=1, keepdims=True)
    places = np.unique(x)[:-3]
    ways = np.maximum(x - places[:, None], 0.0)
    slopes, left = _fitted(ways, y)
    of_step = _fitted(np.sign(ways), y)[1]  # of a zero that the sensor has from there on
    noise = exact + np.square([[scatter(row)] for row in rows]) * len(x) / here.sum()  # of a mean
    gain, by_step = (
        ((free - z) / noise if len(x) < _FEW else np.log((free + exact) / (z + exact))).sum(axis=0)
        * len(x)
        for z in (left, of_step)
    )
    best = int(np.argmax(gain))
    inside, on = slopes[:, best], _fitted(way[None, behind], rows[:, behind])[0][:, 0]
    along = float(inside @ on)
    least, most = (times * float(on @ on) for times in _AS_STEEP)
    by_noise = float(noise.sum() / np.sum((ways[best] - ways[best].mean()) ** 2))
    as_one = along**2 > float(_ALONG**2 * (inside @ inside - by_noise) * (on @ on))
    goes_on = least < along < most and as_one
    level = y[:, x <= places[best]].mean(axis=1, keepdims=True)
    rise = inside @ inside * (length - places[best])
    reached = np.max(inside @ (rows[:, further] - level))
    if gain[best] < max(_CLEAR, by_step.max()) or not goes_on or reached < _ON * rise:
        return None
    return float(places[best]), float(places[gain > gain[best] - _ONSET][0])


def _fitted(shapes: Floats, y: Floats) -> tuple[Floats, Floats]:
    """How much of each shape is in each reading, and the variance of what is left."""
    away = shapes - shapes.mean(axis=1, keepdims=True)
    square = np.maximum(np.sum(away**2, axis=1), np.finfo(float).tiny)
    found = y @ away.T / square
    left = np.var(y, axis=1, keepdims=True) - found**2 * square / y.shape[1]
    return found, np.maximum(left, 0.0)
