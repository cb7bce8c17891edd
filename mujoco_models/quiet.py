"""MuJoCo's warnings, which are counted and heeded, kept out of terminals and files."""

from collections.abc import Iterator
from contextlib import contextmanager

import mujoco

from analytic.problem.errors import InputError

_BAD_STATES = [
    int(bad)
    for bad in (
        mujoco.mjtWarning.mjWARN_BADQPOS,
        mujoco.mjtWarning.mjWARN_BADQVEL,
        mujoco.mjtWarning.mjWARN_BADQACC,
    )
]


@contextmanager
def unlogged() -> Iterator[None]:
    """Keep MuJoCo from writing its warnings to the terminal and to a file in the folder.

    What it refuses only while it runs, as some flexes in contact, is a fault of the model.
    """
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)
    try:
        yield
    except mujoco.FatalError as refused:
        text = str(refused).strip().splitlines()[-1]
        raise InputError(
            "model", f"refused by MuJoCo while it runs ({text})", "one that it runs",
            "change the model",
        ) from refused  # fmt: skip
    finally:
        mujoco.set_mju_user_warning(before)


def has_diverged(data: mujoco.MjData) -> bool:
    """Whether a state has not been finite; MuJoCo only warns, and sets it back."""
    return bool(data.warning.number.take(_BAD_STATES).any())
