"""How well phases are determined from the clamp, measured for both models."""

import pytest

from analytic import CASE_NAMES, PHASES
from compare.sense.transitions import TRANSITIONS
from docs.figures.phase_accuracy import phase_table
from tests.conftest import exact_sweep, simulated_sweep

# Share of stations judged rightly, by noise. Observed at worst: 1, 0.993, 0.911 (0.920 over
# ten seeds). What is wrong is
# nearly all at the first contact, where the force drowns in the noise, and beside the transitions.
RIGHT = {0.0: 1.0, 1e-3: 0.99, 1e-2: 0.905}


@pytest.mark.slow
def test_phases_of_all_cases_and_both_models():
    sweeps = {name: [exact_sweep(name), simulated_sweep(name)] for name in CASE_NAMES}
    table = phase_table(sweeps, seeds=range(4))
    assert len(table) == len(CASE_NAMES) * 2 * len(RIGHT)
    for _, row in table.iterrows():
        assert row["right"] >= RIGHT[row["noise"]], row.to_dict()
        assert row["missed"] == 0
        assert row["free_as_tip"] == row["free_as_tangent"] == 0  # nothing is felt where nothing is
        assert row["tangent_as_free"] == 0
        stations = sum(row[f"{truth}_as_{judged}"] for truth in PHASES for judged in PHASES)
        assert stations == 200 * (4 if row["noise"] else 1)
    calm = table[table["noise"] == 0]
    # Asked are 2 stations. Observed: 0.44; the truth itself is known to half a station.
    assert calm[list(TRANSITIONS)].max(axis=None) <= 0.5
    tip_only = table[table["case"] == "tip-only"]
    assert tip_only[["phase_b_start", "phase_b_end"]].isna().all(axis=None)
