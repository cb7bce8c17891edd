"""A short run of the random foreign models, and long ones that sweep them."""

import pytest

from tests.fuzz import left_out
from tests.fuzz.models import main


@pytest.mark.slow
def test_foreign_models_are_inspected_and_fixed():
    assert main(10, 11) == 0


@pytest.mark.trial
def test_fixed_models_sweep_as_was_expected():
    assert main(30, 8, 30) == 0


@pytest.mark.trial
def test_one_fault_that_is_left_is_named_and_matters():
    assert left_out.main(7, 502) == 0
