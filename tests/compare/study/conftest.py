"""Plans and the command line, for tests of studies."""

from collections.abc import Callable
from functools import partial

import pytest

from compare.study.grid.plan import Plan
from tests.compare.command import Done, vibrissa
from tests.compare.study.studies import planned


@pytest.fixture
def plan_of(tmp_path) -> Callable[[str], Plan]:
    return partial(planned, tmp_path)


@pytest.fixture
def command(tmp_path) -> Callable[..., Done]:
    return partial(vibrissa, cwd=tmp_path)
