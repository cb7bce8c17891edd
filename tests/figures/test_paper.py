"""The paper's figures: all of them of its own vibrissa, fewer of others."""

from dataclasses import replace

import pytest

from analytic import REAL_CASE_NAMES, Sweep, named_case, solve_sweep
from docs.figures.paper import paper_figures


@pytest.mark.parametrize(
    ("name", "drawn"),
    [
        ("shallow-catenary", "figure-12 figure-14 figure-15 figure-16 shapes"),
        (REAL_CASE_NAMES[0], "figure-14 figure-15 figure-16 shapes"),
        (REAL_CASE_NAMES[-1], "figure-14 figure-15"),  # the others hold for uniform vibrissae alone
    ],
)
def test_figures_of_a_case(name, drawn):
    case = replace(named_case(name), sweep=Sweep(stations=30))
    assert " ".join(paper_figures(case, solve_sweep(case))) == drawn
