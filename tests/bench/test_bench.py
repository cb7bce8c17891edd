"""Every part of the bench runs."""

import pytest

from tests.bench.__main__ import PARTS


@pytest.mark.slow
@pytest.mark.parametrize("part", PARTS)
def test_each_part_runs(part: str, capsys: pytest.CaptureFixture[str]) -> None:
    PARTS[part](True)
    assert capsys.readouterr().out.strip()
