"""The net finds what is planted into a set, and lets pass what is on purpose."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.net import difference

SWEEP: dict[str, Any] = {
    "table": {"force_x": [0.0, 1e-18], "force_y": [1.0, 4.0], "status": ["ok", "ok"]},
    "events": {"snap_off": None, "first": {"foot_x": 2.0}},
}


def verdict(folder: Path, new: dict[str, Any], tolerance: float = 1e-12) -> int:
    for name, found in (("old", SWEEP), ("new", new)):
        (folder / name / "room").mkdir(parents=True)
        (folder / name / "room" / "item.json").write_text(json.dumps(found))
    return difference.compare_sets(folder / "old", folder / "new", tolerance)


def changed(*, events: Any = None, **columns: Any) -> dict[str, Any]:
    return {"table": SWEEP["table"] | columns, "events": SWEEP["events"] | (events or {})}


@pytest.mark.parametrize(
    ("new", "differs"),
    [
        (SWEEP, 0),
        (changed(force_y=[1.0, 4.0 + 2e-12]), 0),
        (changed(force_y=[1.0, 4.0 + 8e-12]), 1),
        (changed(force_x=[1e-17, 0.0]), 0),  # rounding of a vector's component
        (changed(force_x=[1e-9, 0.0]), 1),
        (changed(force_y=[1.0, float("nan")]), 1),
        (changed(force_y=[1.0]), 1),
        (changed(status=["ok", "unsettled"]), 1),
        (changed(residual=[0.0, 0.0]), 1),
        (changed(events={"snap_off": {"foot_x": 1.0}}), 1),
        ({"error": "InputError: no"}, 1),
    ],
)
def test_what_differs_is_found(tmp_path: Path, new: dict[str, Any], differs: int) -> None:
    assert verdict(tmp_path, new) == differs


def test_what_is_on_purpose_passes_up_to_its_size(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    meant = difference.Allowed("room/*", 1e-6, "a better rule", places="table.force_?")
    monkeypatch.setattr(difference, "on_purpose", lambda: [meant])
    assert verdict(tmp_path / "one", changed(force_y=[1.0, 4.0 + 1e-7])) == 0
    assert "a better rule" in capsys.readouterr().out
    assert verdict(tmp_path / "two", changed(force_y=[1.0, 4.0 + 1e-4])) == 1
    assert verdict(tmp_path / "three", changed(status=["ok", "lost"])) == 1
