"""A short run of the random foreign models, and long ones that sweep them."""

import random

import pytest

from tests.fuzz import left_out
from tests.fuzz.models import main, trial


@pytest.mark.slow
def test_foreign_models_are_inspected_and_fixed():
    assert main(10, 11) == 0


@pytest.mark.slow
@pytest.mark.parametrize("draw", ["109 35", "121 42", "122 47"])
def test_models_that_were_misread(draw, tmp_path):
    """Meshes that are only seen, a balance far below rounding, balls on a turned foot."""
    assert trial(random.Random(draw), tmp_path).flags == []


@pytest.mark.trial
def test_fixed_models_sweep_as_was_expected():
    assert main(30, 8, 30) == 0


@pytest.mark.trial
def test_one_fault_that_is_left_is_named_and_matters():
    assert left_out.main(7, 502) == 0
