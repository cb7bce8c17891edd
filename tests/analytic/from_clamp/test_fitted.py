"""Which of several families of objects explains readings."""

import numpy as np
import pytest

from analytic.from_clamp.correlated import NoiseFound
from analytic.from_clamp.fitted import Fitted, likeliest

GRID = 91  # noises: white, and those that remember


def fitted(family, white, remembering=-1e3, penalty=0.0):
    by_noise = np.full((GRID, 1), float(remembering))
    by_noise[0] = white
    nothing = NoiseFound(np.zeros(1), np.zeros(1), 0.0, np.zeros(1, dtype=bool))
    return Fitted(
        family=family,
        found={},
        misfit=1.0,
        explains=True,
        by_noise=by_noise,
        penalty=penalty,
        stations=100,
        noise=nothing,
    )


def chosen(*fits):
    by_name = {one.family: one for one in fits}
    return likeliest("auto", tuple(by_name), by_name.__getitem__, otherwise="a corner")


@pytest.mark.parametrize(
    ("white", "penalty", "explains"), [(-104.0, 0.0, True), (-106.0, 0.0, False), (-99, 25.0, True)]
)
def test_what_is_decisively_less_likely_does_not_explain(white, penalty, explains):
    """Unless it is so by the number of its parameters alone: a circle is an ellipse, too."""
    found = chosen(fitted("circle", -100.0), fitted("ellipse", white, penalty=penalty))
    assert found.family == "circle"
    worse = penalty - 2 * (white + 100)
    assert found.rivals["ellipse"][0] - found.rivals["circle"][0] == pytest.approx(worse)
    assert [good for _, good in found.rivals.values()] == [True, explains]
    assert found.others == ["ellipse"] * explains


def test_noise_that_remembers_does_not_excuse_a_wrong_object():
    """It would be the likelier one for a noise of its own."""
    right, wrong = fitted("ellipse", -100.0, penalty=5.0), fitted("circle", -300.0, -50.0)
    assert wrong.bic < right.bic
    found = chosen(right, wrong)
    assert (found.family, found.rivals["circle"][1]) == ("ellipse", False)
