"""Case files that are loaded, or refused in one line."""

import pytest

from analytic import InputError
from compare.read.case import load_case


@pytest.fixture
def load(tmp_path):
    def loaded(text):
        path = tmp_path / "case.toml"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load_case(path)

    return loaded


@pytest.fixture
def refused(load):
    """What is said against a file."""

    def said(text) -> str:
        with pytest.raises(InputError) as error:
            load(text)
        message = str(error.value)
        assert "\n" not in message
        assert len(message) < 600
        return message

    return said
