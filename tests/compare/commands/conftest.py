"""Commands without the pictures of their reports, for tests of what else they do."""

import pytest


@pytest.fixture
def undrawn(monkeypatch):
    """Pages have no pictures and no film: to draw one report's takes as long as ten comparisons.

    That they are drawn is tested by `test_main`, in `tests/compare/show`, and by the pages.
    """
    monkeypatch.setattr("compare.show.animation.write_animation", lambda *_: [])
    monkeypatch.setattr("compare.show.report.FIGURES", {})
    monkeypatch.setattr("compare.show.report._figures", lambda *_: {})
