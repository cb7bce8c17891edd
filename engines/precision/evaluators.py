"""What can evaluate MuJoCo's states at rest here, by name and version."""

from analytic.problem.errors import InputError
from engines.found import installed
from engines.precision.state import Evaluate

_WARP, _MJX = "mujoco-warp>=4.0,<5", "mujoco-mjx>=3.17,<5"


def evaluators() -> dict[str, Evaluate]:
    """All that are installed; raises InputError if none is, or one of a wrong version."""
    (warp, no_warp), (mjx, no_mjx) = installed(_WARP), installed(_MJX)
    for name, version, trouble in (
        ("mujoco-warp", warp, no_warp),
        ("mujoco-mjx", mjx, no_mjx),
    ):
        if version is not None and trouble is not None:
            raise InputError(name, version, "one that --float32 knows", trouble)
    found: dict[str, Evaluate] = {}
    if warp is not None:
        from engines.precision.warp import evaluate

        found[f"MuJoCo Warp {warp}"] = evaluate
    if mjx is not None:
        from engines.precision.mjx import in_double, in_single

        found[f"MJX {mjx}"] = in_single
        found[f"MJX {mjx}, 64 bits"] = in_double
    if not found:
        raise InputError("--float32", "given", "for MuJoCo Warp or MJX", f"{no_warp}, or {no_mjx}")
    return found
