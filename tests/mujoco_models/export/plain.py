"""A written model swept by MuJoCo alone: nothing of the project is in the loop."""

import mujoco
import numpy as np

from analytic import CLAMP_READINGS


def swept(path, case, speed, period):
    """The clamp readings at the case's stations, each the mean over the way round it.

    The foot gets its speed within T1, as users would have it.
    """
    model = mujoco.MjModel.from_xml_path(str(path))
    data, length = mujoco.MjData(model), case.beam.length
    left = 1 if case.sweep.direction == "left" else -1
    foot = model.body("whisker_foot").id
    force, torque = (model.sensor(f"whisker_{word}").adr[0] for word in ("force", "torque"))
    mujoco.mj_forward(model, data)
    way, found = [], []
    end = float((-left * case.foot_x).max()) + 0.1 * length
    while not way or way[-1] < end:
        data.ctrl[0] = -left * speed * length / period * min(1.0, data.time / period)
        mujoco.mj_step(model, data)
        way.append(-left * data.xpos[foot, 0])
        found.append(data.sensordata[[force, force + 1, torque + 2]].copy())
    assert not any(data.warning.number)
    return means(np.array(way), np.array(found), -left * case.foot_x)


def means(way, found, stations):
    half = np.diff(stations).min() / 2
    integral = np.zeros_like(found)
    integral[1:] = np.cumsum((found[1:] + found[:-1]) / 2 * np.diff(way)[:, None], axis=0)
    ends = [
        np.stack([np.interp(stations + side, way, column) for column in integral.T])
        for side in (-half, half)
    ]
    return (ends[1] - ends[0]) / (2 * half)


def worst_rms(exact, readings):
    """Of all stations in contact but for those from 0.04 of the sweep before the snap-off on."""
    foot_x = exact.values("foot_x")
    kept = (exact.table["phase"] != "free").to_numpy()
    if exact.snap_off is not None:
        way, end = np.abs(foot_x - foot_x[0]), abs(exact.snap_off - foot_x[0])
        kept = kept & (way < end - 0.04 * np.ptp(foot_x))
    assert kept.sum() > 20
    return max(
        float(np.sqrt(np.mean((own - wanted)[kept] ** 2)) / np.nanmax(np.abs(wanted)))
        for own, wanted in zip(readings, map(exact.values, CLAMP_READINGS), strict=True)
    )
