"""Which of several families of objects explains readings."""

import numpy as np
import pytest

from analytic import InputError
from analytic.from_clamp.correlated import NoiseFound
from analytic.from_clamp.fitted import Fitted, likeliest

GRID = 91  # noises: white, and those that remember


def fitted(family, white, remembering=-1e3, penalty=0.0, explains=True, judged=True):
    by_noise = np.full((GRID, 1), float(remembering))
    by_noise[0] = white
    nothing = NoiseFound(np.zeros(1), np.zeros(1), 0.0, np.zeros(1, dtype=bool))
    return Fitted(
        family=family,
        found={},
        misfit=1.0,
        explains=explains,
        by_noise=by_noise,
        penalty=penalty,
        stations=100,
        noise=nothing,
        judged=judged,
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


def test_what_cannot_be_judged_is_neither_explained_nor_refused():
    found = chosen(fitted("circle", -100.0, explains=False, judged=False))
    assert found.family == "circle" and not found.explains
    with pytest.raises(InputError, match="none of them"):
        chosen(fitted("circle", -100.0, explains=False))


@pytest.mark.parametrize(
    ("correlation", "lasts", "rests", "judged"),
    [
        (0.9, False, 20, False),
        (0.9, False, 200, True),
        (0.9, False, None, True),  # it is stated
        (0.9, True, 20, True),  # no noise remembers longer than a pass
        (0.0, False, 0, True),
    ],
)
def test_noise_that_remembers_shows_its_size_off_the_contact(correlation, lasts, rests, judged):
    noise = NoiseFound(np.array([correlation]), np.array([9.5]), 0.0, np.array([lasts]))
    assert noise.judged_by(rests) == judged
