"""Reports without their pictures, for tests of what else is done."""

import pytest


@pytest.fixture
def unpictured(monkeypatch):
    """Pages have no pictures: to draw one report's takes as long as ten comparisons.

    That they are drawn is tested by `test_main`, in `tests/compare/show` and `spatial`, by workers'
    reports in `testing`, and by the pages.
    """
    monkeypatch.setattr("compare.show.document.Picture.figures", {})
    monkeypatch.setattr("compare.show.report.readings", lambda *_: b"")
    monkeypatch.setattr("compare.show.report.png", lambda *_: b"")


@pytest.fixture
def undrawn(unpictured, monkeypatch):
    """Nor a film."""
    monkeypatch.setattr("compare.show.animation.plane.write_animation", lambda *_: [])
    monkeypatch.setattr("compare.show.animation.space.write_space_animation", lambda *_: [])
