"""The one line that refuses bad input."""

import pytest

from analytic import InputError


def refusal(make, *args, **kwargs) -> str:
    with pytest.raises(InputError) as refused:
        make(*args, **kwargs)
    assert "\n" not in str(refused.value)
    return str(refused.value)
