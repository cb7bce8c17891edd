"""A sweep at rest in double precision, looked at in single: where contacts are lost, and why.

Every state is MuJoCo's own, at rest. MuJoCo Warp or MJX then evaluates it, so that what differs is
not the way to a balance but the balance itself.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.errors import InputError
from engines.found import installed
from engines.precision.resolution import across, chance_of_loss, covariance, force_deviation
from engines.precision.state import Evaluate, Evaluated, State
from mujoco_models.model.model import BeamModel
from mujoco_models.settings import Settings
from mujoco_models.sweep.sweep import set_out

_WARP, _MJX = "mujoco-warp>=4.0,<5", "mujoco-mjx>=3.17,<5"


def evaluators() -> dict[str, Evaluate]:
    """All that are installed; raises InputError if none is, or one of a wrong version."""
    (warp, no_warp), (mjx, no_mjx) = installed(_WARP), installed(_MJX)
    for name, version, trouble in (("mujoco-warp", warp, no_warp), ("mujoco-mjx", mjx, no_mjx)):
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


def gate(
    case: Case,
    settings: Settings,
    evaluators: Mapping[str, Evaluate],
    stiffnesses: Sequence[float],
    advance: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    if not settings.elsewhere:
        allowed = "'chain' in the plane, on linear springs"
        raise InputError("beam for --float32", repr(settings.beam), allowed, "take --beam chain")
    # The mirror image has the same numbers, but for the sign of x.
    leftward = case.mirrored() if case.foot_x[-1] > case.foot_x[0] else case
    states, expected = [], []
    for stiffness in stiffnesses:
        numerics = replace(settings, obstacle="primitive", contact_stiffness=stiffness)
        walk = set_out(leftward, numerics)
        for foot_x in (leftward.foot_x / leftward.beam.length).tolist():
            walk.go_to(foot_x)
            if walk.doubt is None and walk.model.contacts().loaded.any():
                states.append(State.of(walk.model))
                expected.append(_expected(walk.model, foot_x))
            advance()
    if not states:
        raise InputError("case", case.name, "with a station in contact", "let the sweep reach it")
    rows = [
        {"evaluator": name} | _compared(*one, found)
        for name, evaluate in evaluators.items()
        for one, found in zip(expected, evaluate(states), strict=True)
    ]
    return pd.DataFrame(rows)


def by_stiffness(table: pd.DataFrame) -> pd.DataFrame:
    """What was found and what was predicted, for each evaluator and contact stiffness."""
    rows = []
    for (name, stiffness), group in table.groupby(["evaluator", "contact_stiffness"], sort=False):
        largest = group["load"].max()
        off = (group["depth_error"] / group["resolution"]).dropna()
        rows.append(
            {
                "evaluator": name,
                "contact_stiffness": stiffness,
                "stations": len(group),
                "depth": group["depth"].median(),
                "resolution": group["resolution"].median(),
                "lost": int(group["lost"].sum()),
                "predicted_lost": group["chance"].sum(),
                "force_error": _rms(group["force_error"]) / largest,
                "predicted_force_error": _rms(group["predicted_force_error"]) / largest,
                "imbalance": _rms(group["imbalance"]),
                "predicted_imbalance": _rms(group["predicted_imbalance"]),
                "depth_error": _rms(off) if len(off) else np.nan,
            }
        )
    return pd.DataFrame(rows)


def _rms(numbers: pd.Series) -> float:
    return float(np.sqrt((numbers**2).mean()))


def _expected(model: BeamModel, foot_x: float) -> tuple[int, Floats, dict[str, float]]:
    """The deepest bead of a state at rest, its force, and what float32's resolution makes of it."""
    contacts, stiffness = model.contacts(), model.contact_stiffness
    depth, normal = -contacts.distance, contacts.normal
    together = covariance(model, normal, contacts.touch)
    deviation = np.sqrt(np.diag(together))
    # The forces are as alike as the depths are, and each as far off as its contact lets it be.
    off = stiffness * force_deviation(depth, deviation) / deviation
    forces = np.outer(off, off) * together
    levers = (contacts.point[:, None] - model.joint_positions()) @ across(normal)[:, :, None]
    carried = np.arange(levers.shape[1]) <= contacts.link[:, None]
    moments = np.einsum("ij,ik,jk->k", forces, *2 * [carried * levers[:, :, 0]])
    deepest = int(np.argmax(depth))
    force = stiffness * np.maximum(depth, 0) @ normal
    row = {
        "contact_stiffness": stiffness,
        "foot_x": foot_x,
        "load": float(np.hypot(*force)),
        "depth": float(depth[deepest]),
        "resolution": float(deviation[deepest]),
        "chance": chance_of_loss(depth, together),
        "predicted_force_error": float(np.sqrt((forces * (normal @ normal.T)).sum())),
        "predicted_imbalance": float(np.sqrt(moments.max())),
    }
    return int(contacts.touch[deepest]), force, row


def _compared(
    bead: int, force: Floats, row: dict[str, float], found: Evaluated
) -> dict[str, float | bool]:
    seen = -found.distance[bead]
    return row | {
        "depth_error": float(seen - row["depth"]) if np.isfinite(seen) else np.nan,
        "lost": not (found.distance < 0).any(),
        "force_error": float(np.hypot(*(found.force - force))),
        "imbalance": found.imbalance,
    }
