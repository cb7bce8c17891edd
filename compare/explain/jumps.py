"""What differs from station to station: unrest, noise, steps, hum, jitter of the foot, facets."""

import numpy as np

from analytic import CLAMP_READINGS
from analytic.from_clamp.noise import scatter
from analytic.problem.arrays import Floats
from compare.measure.disagreement import rms
from compare.measure.measurement import Measurement

_JUMPING = 0.5  # fraction of the disagreement's square that jumps from station to station
_STEPPED = (0.5, 2.0)  # times the square that rounding to steps leaves, if they are the cause
_WHOLE = 1e-3  # of a step; so near to a multiple of it
_STEPS = 200  # at most, over a reading: of more, the rounding is no cause of anything
_HUM = 0.8  # fraction of the disagreement's square that one frequency must explain
_TURNS = 8  # periods at least over the sweep: what is slower is a model's own error
_FINER = 4  # frequencies for each of the sweep's own
_ALONG = 0.8  # fraction that lies along the readings' slope, if the foot is off; by chance a third


def uneven(
    found: Measurement, error: Floats, slopes: Floats, jumps: Floats, scale: Floats
) -> str | None:
    """What makes errors, shape (3, stations), that differ from station to station."""
    return (
        _unrest(found, error)
        or _stepped(found, error, scale)
        or _humming(found, error)
        or _jittering(found, error, slopes)
        or _scattered(found, error, jumps, scale)
    )


def _unrest(found: Measurement, error: Floats) -> str | None:
    candidate = found.candidate
    residual = candidate.values("residual")[candidate.trusted]
    if not np.isfinite(residual).any():
        return None
    typical = float(np.sqrt(np.nanmean(residual**2)))
    if typical / found.disagreement["moment_z"].scale < float(np.sqrt(np.mean(error**2))):
        return None
    size = f"{typical / candidate.beam.moment_unit:.1e} EI/L"
    return f"unrest: the stations are out of balance by {size} (rms of `residual`)"


def _stepped(found: Measurement, error: Floats, scale: Floats) -> str | None:
    """Readings that are rounded to few steps, if that is what they are off by."""
    said, due = [], 0.0
    for name, size in zip(CLAMP_READINGS, scale, strict=True):
        values = np.unique(found.candidate.values(name)[found.candidate.trusted])
        apart = np.diff(values)
        if len(values) < 3 or np.ptp(values) > _STEPS * apart.min():
            continue
        step = float(apart.min())
        if np.abs(apart / step - np.round(apart / step)).max() < _WHOLE:
            said.append(f"{name} in steps of {step / size:.1e}")
            due += (step / size) ** 2 / 12
    least, most = (times * due for times in _STEPPED)
    if not said or not least <= float(np.sum(np.mean(error**2, axis=1))) <= most:
        return None
    return f"readings are quantised: {', '.join(said)} of its largest magnitude"


def _humming(found: Measurement, error: Floats) -> str | None:
    """One frequency in all of it; a model's own oscillates from segment to segment."""
    if "segments" in found.candidate.provenance.get("settings", {}):
        return None
    stations = error.shape[1]
    if stations <= 2 * _TURNS:
        return None
    level = error - error.mean(axis=1, keepdims=True)
    power = np.sum(np.abs(np.fft.rfft(level, _FINER * stations)) ** 2, axis=0)
    turns = (_TURNS + np.argmax(power[_FINER * _TURNS : -1]) / _FINER).item()
    phase = 2 * np.pi * turns * np.arange(stations) / stations
    wave = np.linalg.qr(np.column_stack([np.ones(stations), np.cos(phase), np.sin(phase)]))[0]
    heard = float(np.sum((error @ wave[:, 1:]) ** 2))
    if heard < _HUM * np.sum(error**2):
        return None
    sizes = np.sqrt(2) * rms(error)
    names = ", ".join(f"{n} {x:.1e}" for n, x in zip(CLAMP_READINGS, sizes, strict=True))
    return (
        f"hum: the readings oscillate with a period of {stations / turns:.3g} stations ({names} of "
        "their largest magnitudes)"
    )


def _jittering(found: Measurement, error: Floats, slopes: Floats) -> str | None:
    """A foot that is not where the stage says, by another distance at each station."""
    known, whole = np.isfinite(slopes).all(axis=0), np.sum(error**2)
    error, slopes = error[:, known], slopes[:, known]
    steep = np.sum(slopes**2, axis=0)
    if not steep.all() or np.sum(error**2) <= _JUMPING * whole:  # most of it is elsewhere
        return None
    off = np.sum(error * slopes, axis=0) / steep
    along = np.sum(off**2 * steep) >= _ALONG * np.sum(error**2)
    if not along or scatter(off) ** 2 < _JUMPING * np.mean(off**2):
        return None
    name, (_, unit) = found.reference.running, found.reference.running_unit
    size = f"{rms(off):.1e} {unit}"
    return f"jitter of {name} by {size} from station to station: all readings follow it"


def _scattered(found: Measurement, error: Floats, jumps: Floats, scale: Floats) -> str | None:
    if np.sum(jumps**2) < _JUMPING * np.sum(np.mean(error**2, axis=1)):
        return None
    size = f"differences jump from station to station by {jumps.max():.1e}"
    if "segments" not in found.candidate.provenance.get("settings", {}):
        return f"noise: {size}; see `--noise auto`"
    free = found.judged["candidate"].phase == "free"
    if free.sum() < 2:
        return f"facets of a coarse mesh, or noise: {size}"
    idle = np.stack([found.candidate.values(n)[free] for n in CLAMP_READINGS])
    resting = np.median(np.abs(idle / scale[:, None]), axis=1)
    if (resting > jumps / 3).all():
        return f"noise: {size}, and without contact they do too; see `--noise auto`"
    return f"facets of a coarse mesh: {size}, but not without contact"
