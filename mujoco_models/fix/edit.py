"""What is to be changed in a model: attributes of its elements, and elements that it lacks."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Edit:
    """New values of attributes of some elements of one kind."""

    # Of MJCF, as joint or flag; edge for a flex's <edge>, contact for its <contact>.
    kind: str
    attributes: tuple[tuple[str, str], ...]  # names and values; an empty value takes it away
    numbers: tuple[int, ...] = ()  # of the elements in the compiled model

    def __str__(self) -> str:
        return " ".join(f'{name}="{value}"' for name, value in self.attributes if value)


@dataclass(frozen=True)
class Insert:
    """An element that is put into a body, or at the end of the model."""

    text: str
    body: int | None = None  # its number in the compiled model

    def __str__(self) -> str:
        return self.text


def number(x: float) -> str:
    """As a file holds it; three digits are enough of what is chosen."""
    return f"{x:.3g}"
