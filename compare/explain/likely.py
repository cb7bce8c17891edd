"""What a disagreement looks like: the record first, then known mistakes and faults."""

from collections.abc import Iterator

import numpy as np

from analytic import CLAMP_READINGS, Readings
from analytic.from_clamp.noise import reading_noise, scatter
from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.space import SpatialReadings
from compare.explain.causes import slopes
from compare.explain.one_or_two import one_or_two
from compare.explain.stations import agree_to, begun, ended, lone, next_to_snap_off, without_contact
from compare.judge.allowance import NoiseAllowance
from compare.judge.tolerances import Tolerances
from compare.measure.disagreement import before_snap_off, rms
from compare.measure.measurement import Measurement

_FEWEST = 10  # stations
_HIDES = 0.1  # of the reference's largest force; noise of one component
_ALIKE = 2.5  # times the rms of noise in contact is that without; of AR(0.97) in 20 stations, too
_MOVES = 0.3  # times what it is off in rms, such a reading varies; a zero that is wrong does not
_ALLOWED = 2.0  # times the noise that the limits are widened by, a hum jumps by 16/sqrt(70) of it
_SINKS = 0.05  # of the radius
_ROUND_OFF = 1e-12  # of the largest magnitude; nothing below has a cause


def likely_cause(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> str | None:
    """What explains nearly all of a disagreement; None if nothing stands out.

    That both state objects of two kinds comes first, for what is fitted knows one alone.
    """
    cause = _cause(found, limits, noise)
    one, other = (str(x.provenance.get("profile", "")) for x in (found.reference, found.candidate))
    if not one or not other or one.split()[0] == other.split()[0]:
        return cause
    return "; else ".join(filter(None, (f"two objects: {one}, and the candidate's {other}", cause)))


def to_find_out(reference: Readings, candidate: Readings) -> str:
    """What to do next where the readings alone do not show a cause."""
    rig = "check its units and columns, the vibrissa's length and rigidity, the object's place"
    split = {
        "mujoco ": "too few segments and a soft contact err alike: `vibrissa run CASE --budget` "
        "measures the parts of a MuJoCo model",
        "model ": "`vibrissa inspect` names the model's faults, --budget measures the parts",
    }
    advice = {
        **(split if has_budget(reference, candidate) else {}),
        "measured": rig,
        "": "of a simulator, refine one thing at a time (elements, time step, rest, contact, "
        f"obstacle) and see which makes them agree; of a rig, {rig}",
    }
    does = next(to for who, to in advice.items() if candidate.source.startswith(who))
    return f"the readings alone do not show why; {_sinking(reference, candidate) or does}"


def _sinking(reference: Readings, candidate: Readings) -> str | None:
    """That a contact is so soft that a disagreement may be of that alone, and how hard it must be.

    Past corners in motion, an rms depth of 0.05 to 0.1 radii made readings 1e-2 off.
    """
    radii = candidate.values("penetration")[candidate.trusted] / (reference.beam.radius or np.inf)
    typical = float(rms(radii[radii > 0])) if (radii > 0).any() else 0.0
    if typical < _SINKS:
        return None
    at = candidate.running_values[candidate.trusted][int(np.nanargmax(radii))]
    size, unit = reference.running_unit
    harder = typical / (_SINKS / 2)
    return (
        f"the contact sinks by up to {np.nanmax(radii):.2g} radii (at {reference.running} = "
        f"{at / size:.4g} {unit}): make it {harder:.2g} times as stiff, in motion in steps "
        f"{harder**-0.5:.2g} times as long"
    )


def has_budget(
    reference: Readings | SpatialReadings, candidate: Readings | SpatialReadings
) -> bool:
    """Whether ``run --budget`` can split what MuJoCo's sweep disagrees by: see `measure_budget`."""
    stated, motion = reference.provenance, candidate.provenance.get("motion")
    if "others" in stated or stated.get("support", stated).get("friction"):
        return False
    if motion is None or reference.running == "foot_x":
        return True
    return isinstance(reference, Readings) and motion["average"] == 0


@np.errstate(over="ignore", invalid="ignore")  # a reading of 1e150 has a cause, too
def _cause(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> str | None:
    """What explains nearly all of a disagreement past one object.

    Defects of the record come first: if the readings agree at the stations without one, they are
    the whole cause. Else the one known mistake or fault is named that explains nearly all of the
    disagreement at those stations, if the next one explains clearly less. Unrest is recognised by
    the candidate's own ``residual``, facets and noise by differences that jump from station to
    station, everything else by fitting the size of each fault's signature.
    """
    if found.order.opposite:
        both = f"{found.order.column} and moment_z"
        return f"opposite direction of travel: {both} run opposite to the reference's"
    notes = [note] if (note := found.order.note) else []
    notes += [x for x in found.records["candidate"].defects() if not x.startswith("rows out of")]
    if not found.alignment.counts["compared"]:
        return "; ".join(notes) or _untouched(found)
    table = found.alignment.table
    window = before_snap_off(
        found.reference, table["at"].to_numpy(), found.snap_off, limits.snap_off_window
    )
    sound = found.records["candidate"].sound[table["station"].to_numpy()]
    table = table[~window & sound].reset_index(drop=True)
    scale = np.array([found.disagreement[name].scale for name in CLAMP_READINGS])
    true, seen = (
        np.stack([table[f"{name}_{which}"] for name in CLAMP_READINGS]) / scale[:, None]
        for which in ("reference", "candidate")
    )
    error = seen - true
    short = _short(found)
    if len(table) < _FEWEST:
        short = short if len(table) and agree_to(error, limits, noise) else []
        return "; ".join([*notes, *_doubted(found), *short]) or None
    jumps = np.array([scatter(row) for row in error])
    known = np.array([noise.level[name] for name in CLAMP_READINGS])
    many = found.alignment.counts["untrusted"] > limits.untrusted * len(found.candidate.table)
    doubted = [*_doubted(found)] if many and not notes else []
    if (notes or doubted or short) and agree_to(error, limits, noise):
        return "; ".join([*notes, *doubted, *short])
    at = table["at"].to_numpy()
    _, before = begun(found, limits, at)
    after = error[:, ~before]
    agree = agree_to(after, limits, noise)
    cause = lone(found, after, at[~before], limits, noise)
    if cause is None and agree:
        cause = without_contact(found, limits, noise) or next_to_snap_off(found, limits, noise)
    if cause is None and np.sqrt(np.mean(error**2)) >= _ROUND_OFF:
        cause = (
            _unrest(found, error)
            or _stepped(found, error, scale)
            or _held(found, table["station"].to_numpy(), error)
            or _humming(found, error)
            or _jittering(found, error, found.reference.running_unit[0] * slopes(table, true))
            or _scattered(found, error, np.where(jumps > _ALLOWED * known, jumps, 0.0), scale)
            or one_or_two(found, table, true, seen, scale, np.maximum(jumps, known))
            or _remembering(found, error, scale)
        )
    if cause is None or cause.startswith("noise"):
        late = ended(found, limits) if agree_to(error, limits, noise, jumps) else None
        cause = "; ".join(filter(None, (late, cause))) or None
    if notes and cause is None:
        return "; ".join([*notes, "beside that the readings disagree, and do not show why"])
    return "; beside that ".join(filter(None, (cause, "; ".join(notes)))) or None


def _untouched(found: Measurement) -> str | None:
    """Why no station of the candidate is in contact, if that is so by its clamp."""
    table, seen = found.candidate.table, found.judged["candidate"].phase
    idle, unknown = seen == "free", seen == ""
    if not (idle | unknown).all():
        return None
    noise = reading_noise(found.candidate)
    jumps = {n: noise[n] / found.disagreement[n].scale for n in CLAMP_READINGS[:2]}
    worst = max(jumps, key=jumps.__getitem__)
    if jumps[worst] > _HIDES:
        return (
            f"{worst} jumps from station to station by {jumps[worst]:.0%} of the reference's "
            "largest, and hides any load: what the sensor is on swings, its readings are noise, or "
            "its stations are not at rest"
        )
    touching = (table["phase"] != "free").to_numpy() if "phase" in table else np.zeros_like(idle)
    if (idle & touching).any():
        return (
            f"the clamp reads no load, though the candidate records a contact at "
            f"{(idle & touching).sum()} stations: the sensor measures something else, or nothing"
        )
    if unknown.any():
        return f"no station with a load is to be trusted: {'; '.join(_doubted(found))}"
    return "the candidate never touches: its clamp reads no load at any station"


def _doubted(found: Measurement) -> Iterator[str]:
    """How many stations the candidate does not trust, and why most of them."""
    doubted, reasons = ~found.candidate.trusted, found.candidate.provenance.get("unsettled") or {}
    if doubted.any():
        mostly = f", mostly as {max(reasons, key=reasons.__getitem__)}" if reasons else ""
        yield f"{doubted.sum()} of {len(doubted)} stations are not to be trusted{mostly}"


def _short(found: Measurement) -> list[str]:
    """That the sweep does not cover all events and all contact of the reference."""
    beyond = found.beyond() or ["contact"] * any(found.cut_off())
    if not beyond:
        return []
    size, unit = found.reference.running_unit
    at, name = found.candidate.running_values / size, found.reference.running
    return [
        f"too short a sweep: it covers {name} = {at.min():.4g} to {at.max():.4g} {unit}, and "
        f"{' and '.join(beyond)} of the reference lie{'s' * (len(beyond) == 1)} beyond"
    ]


_ANGULAR = "facets of a coarse mesh, or links too long for the object"
_JUMPING = 0.5  # fraction of the disagreement's square that jumps from station to station
_STEPPED = (0.5, 2.0)  # times the square that rounding to steps leaves, if they are the cause
_WHOLE = 1e-3  # of a step; so near to a multiple of it
_STEPS = 200  # at most, over a reading: of more, the rounding is no cause of anything
_OFTEN = 0.2  # of the readings in contact: so many that repeat the one before are no chance
_STANDS = 5  # stations one after the other that repeat the one before: no chance, either
_FRESH = 0.3  # times what repeated ones are off, new ones are at most
_HUM = 0.8  # fraction of the disagreement's square that one frequency must explain
_TURNS = 8  # periods at least over the sweep: what is slower is a model's own error
_FINER = 4  # frequencies for each of the sweep's own
_ALONG = 0.8  # fraction that lies along the readings' slope, if the foot is off; by chance a third


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


def _held(found: Measurement, stations: Integers, error: Floats) -> str | None:
    """Readings that are new at some stations only, if those agree."""
    still = np.stack(
        [np.append(False, np.diff(found.candidate.values(n)) == 0) for n in CLAMP_READINGS]
    )
    loaded = found.judged["candidate"].phase != "free"
    often, name = float(np.mean(np.all(still[:, loaded], axis=0))), found.reference.running
    stuck = np.array([_run(row & loaded) for row in still])
    same = np.asarray(still.all(axis=0) if often >= _OFTEN else stuck.any(axis=0))
    held = same[stations]
    if not held.any() or held.all():
        return None
    if rms(error[:, ~held]).max(initial=0.0) > _FRESH * rms(error[:, held]).max(initial=0.0):
        return None
    if often < _OFTEN:
        readings = " and ".join(n for n, s in zip(CLAMP_READINGS, stuck, strict=True) if s.any())
        ends = found.candidate.running_values[np.flatnonzero(same)[[0, -1]]]
        size, unit = found.reference.running_unit
        return (
            f"readings stand still: {readings} at {same.sum()} stations, {name} = "
            f"{ends[0] / size:.4g} to {ends[1] / size:.4g} {unit}, while {name} goes on"
        )
    return (
        f"readings are held: {often:.0%} of those in contact repeat the ones before while "
        f"{name} goes on; whatever writes them is slower than the rows"
    )


def _run(same: Booleans) -> Booleans:
    """The longest row of stations that repeat the one before, if it is no chance."""
    places = np.arange(len(same))
    counts = places - np.maximum.accumulate(np.where(same, -1, places))
    last = int(np.argmax(counts))
    long = counts[last] >= _STANDS
    return np.asarray((last - counts[last] < places) & (places <= last) & long)


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


def _remembering(found: Measurement, error: Floats, scale: Floats) -> str | None:
    """Noise that hardly jumps, if it is there without a contact, too."""
    if "segments" in found.candidate.provenance.get("settings", {}):
        return None
    touching = found.reference.running_values[found.judged["reference"].phase != "free"]
    at = found.candidate.running_values
    idle = found.candidate.trusted & ((at < touching.min()) | (at > touching.max()))
    if idle.sum() < _FEWEST:
        return None
    resting = np.stack([found.candidate.values(n)[idle] for n in CLAMP_READINGS]) / scale[:, None]
    jumps = np.array([scatter(row) for row in resting])
    idles, sizes = rms(resting), rms(error)
    alike = (sizes / _ALIKE < idles) & (idles < sizes * _ALIKE)
    stays = (resting.std(axis=1) < _MOVES * idles).any()
    if not alike.all() or stays or np.sum(jumps**2) >= _JUMPING * np.sum(idles**2):
        return None
    return (
        "noise that remembers, or a zero that drifts: without contact the readings are off by as "
        f"much, {idles.max():.1e} rms"
    )


def _scattered(found: Measurement, error: Floats, jumps: Floats, scale: Floats) -> str | None:
    if np.sum(jumps**2) < _JUMPING * np.sum(np.mean(error**2, axis=1)):
        return None
    size = f"differences jump from station to station by {jumps.max():.1e}"
    if "segments" not in found.candidate.provenance.get("settings", {}):
        return f"noise: {size}; see `--noise auto`"
    free = found.judged["candidate"].phase == "free"
    if free.sum() < 2:
        return f"{_ANGULAR}, or noise: {size}"
    idle = np.stack([found.candidate.values(n)[free] for n in CLAMP_READINGS])
    resting = np.median(np.abs(idle / scale[:, None]), axis=1)
    if (resting > jumps / 3).all():
        return f"noise: {size}, and without contact they do too; see `--noise auto`"
    which = "; --budget shows which" * has_budget(found.reference, found.candidate)
    return f"{_ANGULAR}: {size}, but not without contact{which}"
