"""Every part of the bench runs, and nothing has become dearer by a third."""

import pytest

from tests.bench.__main__ import PARTS
from tests.bench.ratios import Measured, costs, last, measure, measured_on, processor, regressions


@pytest.mark.slow
@pytest.mark.parametrize("part", PARTS)
def test_each_part_runs(part: str, capsys: pytest.CaptureFixture[str]) -> None:
    PARTS[part](True)
    assert capsys.readouterr().out.strip()


@pytest.mark.slow
@pytest.mark.skipif(measured_on() != processor(), reason="the history is of another processor")
@pytest.mark.parametrize("name", last())
def test_nothing_has_become_dearer(name: str) -> None:
    cost, before = costs()[name], {name: last()[name]}
    found = regressions({name: measure(cost, 3)}, before)
    if found:  # in more pairs: the machine may have been busy with what slows only one of the two
        found = regressions({name: measure(cost)}, before)
    assert not found


def test_a_regression_is_one_of_more_than_three_tenths() -> None:
    before = {"a sweep": 2.0, "a contact": 1.0, "forgotten": 1.0}
    now = {"a sweep": Measured(2.7, 0.1), "a contact": Measured(1.25, 0.3)}
    assert regressions(now, before) == ["a sweep: 2.7, 1.35 times 2"]
