"""Two causes are named only where they leave far less than one."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from compare.explain import one_or_two as module
from compare.explain.causes import Cause
from compare.explain.fit import Explanation

STATIONS = 30


@pytest.mark.parametrize(
    ("times", "said"),
    [(5.0, "a gain; 20% of the disagreement is left"), (20.0, "a gain and a zero")],
)
def test_two_must_leave_ten_times_less_than_one(monkeypatch, times, said):
    """Of a disagreement whose square is 1, one cause leaves 0.04."""
    true = np.zeros((3, STATIONS))
    seen = np.full((3, STATIONS), np.sqrt(1 / (3 * STATIONS)))
    fault = SimpleNamespace(signature=true, over=lambda known: fault, needs_contour=True)
    alone = [Explanation("a gain", 0.04), Explanation("", 0.5)]
    together = [Explanation("a gain and a zero", 0.04 / times, 2), Explanation("", 0.4, 2)]
    monkeypatch.setattr(module, "physical_faults", lambda *_: [fault])
    monkeypatch.setattr(module, "sensor_faults", lambda _: [])
    monkeypatch.setattr(module, "misread", lambda *_: [])
    monkeypatch.setattr(module, "_alone", lambda *_: alone)
    monkeypatch.setattr(module, "_both", lambda *_: together)
    table = pd.DataFrame({"at": np.linspace(1, -1, STATIONS), "phase": "tip"})
    beam = SimpleNamespace(length=1.0)
    offset = SimpleNamespace(uncertainty=0.0)
    found = SimpleNamespace(reference=SimpleNamespace(beam=beam, running=""), offset=offset)
    text = module.one_or_two(found, table, true, seen, np.ones(3), np.zeros(3))
    assert text == said


def test_a_fault_at_the_end_of_what_it_can_be_is_solved_there():
    """A clamp stated as soft is rigid: its signature alone overshoots, and another fits as well."""
    shape = np.random.default_rng(1).standard_normal((3, STATIONS))
    soft = Cause("clamp {:.2f}".format, shape, -0.05, 1.0, lambda size: 1.1 * size * shape)
    other = Cause("another".format, shape + 0.1 * shape[::-1], -1.0, 1.0)
    true, error = np.zeros_like(shape), -0.055 * shape
    weigh = module.Weigh(float(np.sum(error**2)), 0.0)
    tried = module._alone([soft, other], [], true, error, weigh)
    assert module.best_alone(tried, weigh)[0].text == "clamp -0.05"
    left = module._left_by_two([soft, other], error)[0, 1]
    assert 0 < left < weigh.all / 100
