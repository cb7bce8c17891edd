"""How a study finds the object: by which method to find the contact."""

from typing import Annotated

from pydantic import AfterValidator

from compare.read.quantities import Table


def _known(name: str) -> str:
    from analytic.from_clamp.earlier.methods import NAMES  # slow to load, and few studies name one

    if name not in NAMES:
        raise ValueError(f"a method is one of {', '.join(NAMES)}")
    return name


class Estimator(Table):
    """The method that ``reconstruction`` is recorded of."""

    # Name of a method, as `analytic.reconstruct` takes it.
    method: Annotated[str, AfterValidator(_known)] = "elastica"
