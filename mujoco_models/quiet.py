"""MuJoCo's warnings, which are counted and heeded, kept out of terminals and files."""

from collections.abc import Iterator
from contextlib import contextmanager

import mujoco


@contextmanager
def unlogged() -> Iterator[None]:
    """Keep MuJoCo from writing its warnings to the terminal and to a file in the folder."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(before)
