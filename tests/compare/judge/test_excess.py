"""By how many times each limit is exceeded, and where a limit begins to be."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS
from compare import Tolerances, compare
from compare.align.offset import without_offset
from compare.judge.allowance import NoiseAllowance
from compare.sense.noise import with_noise
from tests.compare.synthetic import changed, scaled, solved


def exceeded(candidate, limits: Tolerances, **how) -> dict[str, float]:
    return {f.name: f.excess for f in compare(solved(), candidate, limits, **how).exceeded}


def test_a_reading_by_its_rms_and_by_its_worst_station():
    """A limit of just what it is off by is met."""
    candidate = scaled(solved(), force_y=1.01)
    off = compare(solved(), candidate).disagreement["force_y"]
    loose = {"rms": 1.0, "max": 1.0, "snap_off": 1.0, "transition": 1.0, "phase_agreement": 0.0}
    for kind, size in (("rms", off.rms), ("max", off.max)):
        asked = Tolerances(**{**loose, kind: size / 4})
        assert exceeded(candidate, asked) == {"force_y": pytest.approx(4.0)}
        for more, fails in ((1 - 1e-9, True), (1 + 1e-9, False)):
            just = Tolerances(**{**loose, kind: size * more})
            assert bool(exceeded(candidate, just)) == fails
    for phase, size in off.rms_by_phase.items():
        special = Tolerances(**loose, special={f"force_y.{phase}.rms": size / 3})
        assert exceeded(candidate, special) == {"force_y": pytest.approx(3.0)}
        peak = off.peaks[phase].size
        special = Tolerances(**loose, special={f"{phase}.max": peak / 5})
        assert exceeded(candidate, special) == {"force_y": pytest.approx(5.0)}


@pytest.mark.parametrize("late", [0.03, -0.03])
def test_an_event_in_lengths_of_the_vibrissa(late):
    """Of 2: a snap-off 0.03 away is 1.5 times what a limit of 0.01 allows."""
    events = {**solved().provenance["events"], "snap_off": solved().snap_off - late}
    other = replace(solved(), provenance={**solved().provenance, "events": events})
    assert exceeded(other, Tolerances(snap_off=0.01)) == {"snap_off": pytest.approx(1.5)}
    assert exceeded(other, Tolerances(snap_off=0.01501)) == {}


def test_what_is_uncertain_of_an_event_is_allowed_for():
    """Half a step, where the candidate does not say where it lets go."""
    rig = replace(without_offset(solved(), 0.1), provenance={})
    snap = compare(solved(), rig).snap_off
    allowed = 0.01 * solved().beam.length + snap.uncertainty
    found = exceeded(rig, Tolerances(snap_off=0.01))
    assert found["snap_off"] == pytest.approx(abs(snap.difference) / allowed)
    assert snap.uncertainty > 0


def test_noise_widens_what_is_asked_of_a_station_and_of_phases():
    loose = {"rms": 1.0, "max": 1.0, "snap_off": 1.0, "transition": 1.0}
    force = solved().values("force_y") + 0.5 * np.abs(solved().values("force_y")).max() * (
        np.arange(128) == 40
    )
    spiked = changed(solved(), force_y=force)
    limits = Tolerances(**loose | {"max": 0.1})
    found = compare(solved(), spiked, limits, noise=0.02)
    one = found.disagreement["force_y"]
    excess = one.max / found.noise.max(0.1, "force_y", one.stations)
    assert exceeded(spiked, limits, noise=0.02)["force_y"] == pytest.approx(excess)
    noisy = with_noise(solved(), dict.fromkeys(CLAMP_READINGS, 1e-2), 1)
    strict = Tolerances(**loose, phase_agreement=1.0)
    assert "phases of the candidate" in exceeded(noisy, strict)
    assert "phases of the candidate" not in exceeded(noisy, strict, noise=1e-2)


def test_only_late_is_allowed_for_by_lateness():
    """The foot moves to the left."""
    for late, excess in ((0.06, {"snap_off": 1.5}), (0.039, {}), (-0.03, {"snap_off": 3.0})):
        events = {**solved().provenance["events"], "snap_off": solved().snap_off - late}
        other = replace(solved(), provenance={**solved().provenance, "events": events})
        found = exceeded(other, Tolerances(snap_off=0.005, lateness=0.015))
        assert found == pytest.approx(excess)


def test_stations_by_their_share():
    status = np.where(np.isin(np.arange(128), [30, 40, 50, 60]), "unsettled", "ok")
    lost = changed(solved(), status=status)
    assert exceeded(lost, Tolerances(untrusted=1 / 128))["stations"] == pytest.approx(4.0)
    assert "stations" not in exceeded(lost, Tolerances(untrusted=4 / 128))


def test_what_noise_adds():
    """White noise of size s over n stations: chi-square's mean and spread, and the largest of n.

    3.0902 standard deviations are exceeded once in a thousand; 4.4172 by one of a hundred, on
    either side, as often.
    """
    noise = NoiseAllowance(dict.fromkeys(CLAMP_READINGS, 0.01))
    s, limit, n = 0.01, 0.02, 100
    spread = np.sqrt((2 * s**4 + 4 * s**2 * limit**2) / n)
    assert noise.rms(limit, "force_x", n) == pytest.approx(
        np.sqrt(limit**2 + s**2 + 3.09023 * spread), rel=1e-6
    )
    assert noise.max(limit, "force_x", n) == pytest.approx(limit + 4.41717 * s, rel=1e-5)
    calm = NoiseAllowance()
    assert (calm.rms(limit, "force_x", n), calm.max(limit, "force_x", n)) == (limit, limit)


def test_the_most_special_limit_holds():
    special = {"tip.max": 0.5, "force_x.max": 0.25, "force_x.tip.max": 0.125, "tip.rms": 0.75}
    limits = Tolerances(max=1.0, rms=2.0, special=special)
    asked = (("force_x", "tip"), ("force_x", "tangent"), ("force_y", "tip"), ("force_y", "tangent"))
    assert [limits.of(r, "max", p) for r, p in asked] == [0.125, 0.25, 0.5, 1.0]
    assert [limits.of_phase(*one) for one in asked] == [0.75, None, 0.75, None]
    assert limits.of("force_x", "rms") == 2.0
