"""What input tests have in common: the one line that refuses it, and files that were damaged."""

import pytest
from hypothesis import strategies as st

from analytic import InputError


def refusal(make, *args, **kwargs) -> str:
    with pytest.raises(InputError) as refused:
        make(*args, **kwargs)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def damage(data: st.DataObject, path, times: int) -> None:
    """Bytes changed, cut, doubled or inserted."""
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, times))):
        at = data.draw(st.integers(0, len(content)))
        match data.draw(st.sampled_from(["change", "cut", "double", "insert"])):
            case "change" if at < len(content):
                content[at] = data.draw(st.integers(0, 255))
            case "cut":
                del content[at : at + data.draw(st.integers(1, 200))]
            case "double":
                content[at:at] = content[: data.draw(st.integers(1, 400))]
            case _:
                content[at:at] = data.draw(st.binary(max_size=30))
    path.write_bytes(content)
