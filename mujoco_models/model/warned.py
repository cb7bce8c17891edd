"""What MuJoCo warns of in its own motion."""

import mujoco

_BAD_STATES = [
    int(bad)
    for bad in (
        mujoco.mjtWarning.mjWARN_BADQPOS,
        mujoco.mjtWarning.mjWARN_BADQVEL,
        mujoco.mjtWarning.mjWARN_BADQACC,
    )
]


def has_diverged(data: mujoco.MjData) -> bool:
    """Whether a state has not been finite; MuJoCo only warns, and sets it back."""
    return bool(data.warning.number.take(_BAD_STATES).any())
