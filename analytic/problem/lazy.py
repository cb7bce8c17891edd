"""Names of a package that are loaded when first used; one that is nearly right is corrected."""

from collections.abc import Callable
from typing import Any

import lazy_loader

from analytic.problem.errors import near


def attach(
    package: str, file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """What a package needs as ``__getattr__``, ``__dir__`` and ``__all__``, by its stub."""
    load, listed, names = lazy_loader.attach_stub(package, file)

    def loaded(name: str) -> Any:  # noqa: ANN401
        try:
            return load(name)
        except AttributeError:
            if name in names:
                raise
        remedy = near(name, names, f"dir({package}) lists what it has")
        raise AttributeError(f"{package} has no {name!r}; {remedy}")

    return loaded, listed, names
