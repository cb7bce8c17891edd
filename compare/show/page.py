"""How numbers are written for people."""


def short(x: float | None) -> str:
    """Two digits and a power of ten, as 1.2e-3; ``none`` for what does not exist."""
    if x is None:
        return "none"
    return f"{x:.1e}".replace("e-0", "e-").replace("e+0", "e+") if x else "0"


def place(x: float | None) -> str:
    """A position, to what a picture could show."""
    return "none" if x is None else f"{x:.5g}"
