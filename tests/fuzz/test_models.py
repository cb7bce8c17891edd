"""A short run of the random foreign models, and a long one that sweeps them."""

import pytest

from tests.fuzz.models import main


@pytest.mark.slow
def test_foreign_models_are_inspected_and_fixed():
    assert main(10, 11) == 0


@pytest.mark.trial
def test_fixed_models_sweep_as_was_expected():
    assert main(30, 8, 30) == 0
