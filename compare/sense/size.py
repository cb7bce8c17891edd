"""Numbers that are too large to be readings."""

import numpy as np

from analytic import SENSED, InputError, Readings

_LARGEST = 1e40  # of the beam's units; a sixth power still is a number


def check_size(which: str, sweep: Readings) -> None:
    """Refuse numbers whose powers would overflow."""
    beam, trusted = sweep.beam, sweep.trusted
    units = (beam.length, beam.force_unit, beam.force_unit, beam.moment_unit)
    for name, unit in zip(SENSED, units, strict=True):
        values = sweep.values(name)[trusted]
        largest = np.abs(values).max(initial=0.0)
        if not largest < _LARGEST * unit:
            raise InputError(
                f"{name} of the {which} ({sweep.source})",
                f"{largest:.3g}",
                f"less than {_LARGEST:g} of the beam's units ({unit:.3g})",
                "check the units, and the beam",
            )
