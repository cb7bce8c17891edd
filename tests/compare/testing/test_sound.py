"""A user's MuJoCo model, asserted to be sound."""

import pytest

from analytic import Beam, InputError
from compare import assert_sound


def test_a_sound_model_passes_and_each_fault_is_a_line():
    meant = Beam(length=0.1, flexural_rigidity=6.44e-4, radius=0.25e-3)
    assert_sound("sound-chain", meant)
    with pytest.raises(AssertionError) as caught:
        assert_sound("sound-chain", meant.scaled(rigidity=0.9))
    title, fault = str(caught.value).splitlines()
    assert title == "sound-chain is not sound:"
    assert fault.startswith("  fault, EI: 0.000644, which is 11.1% more than stated (0.0005796)")
    with pytest.raises(InputError, match="stated = an int"):
        assert_sound("sound-chain", 3)
