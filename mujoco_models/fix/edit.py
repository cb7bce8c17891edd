"""What is to be changed in a model: attributes of its elements, and elements that it lacks."""

import re
from dataclasses import dataclass, replace
from itertools import chain, count

import mujoco

_COUNTS = {"joint": "njnt", "site": "nsite", "sensor": "nsensor"}  # of what is put between others
_NAMED = re.compile(r'\b(name|site|joint)="([^"]*)"')  # by what is put in


@dataclass(frozen=True)
class Edit:
    """New values of attributes of some elements of one kind."""

    # Of MJCF, as joint or flag; edge for a flex's <edge>, contact for its <contact>.
    kind: str
    attributes: tuple[tuple[str, str], ...]  # names and values; an empty value takes it away
    numbers: tuple[int, ...] = ()  # of the elements in the compiled model

    @property
    def of_all(self) -> bool:
        """Whether it is of the model, and not of elements that have numbers."""
        return self.kind in ("option", "flag")

    def of(self, before: mujoco.MjModel, now: mujoco.MjModel) -> "Edit":
        """With the numbers that its elements had before others, which have names, were put in."""
        if self.kind not in _COUNTS:
            return self
        old, new = (
            [getattr(m, self.kind)(i).name for i in range(getattr(m, _COUNTS[self.kind]))]
            for m in (before, now)
        )
        added = [i for i, name in enumerate(new) if name and name not in old]
        own = (n for n in self.numbers if n not in added)
        return replace(self, numbers=tuple(n - sum(i < n for i in added) for n in own))

    def with_free_names(self, model: mujoco.MjModel) -> "Edit":
        """On a site that is put in, by the name that it gets."""
        renamed = ((n, _free(v, model) if n == "site" else v) for n, v in self.attributes)
        return replace(self, attributes=tuple(renamed))

    def __str__(self) -> str:
        return " ".join(f'{name}="{value}"' for name, value in self.attributes if value)


@dataclass(frozen=True)
class Insert:
    """An element that is put into a body or around it, or at the end of the model."""

    text: str
    body: int | None = None  # its number in the compiled model
    around: str = ""  # the name of a body that is to hold both, if the file lets it

    def with_free_names(self, model: mujoco.MjModel) -> "Insert":
        """With names that nothing in the model has, as another vibrissa's sensor may."""
        text = _NAMED.sub(lambda x: f'{x[1]}="{_free(x[2], model)}"', self.text)
        return replace(self, text=text, around=self.around and _free(self.around, model))

    def __str__(self) -> str:
        around = f'<body name="{self.around}">{self.text} ... </body>'
        return around if self.around else self.text


def _free(name: str, model: mujoco.MjModel) -> str:
    taken = bytes(model.names).decode().split("\0")
    return next(x for x in chain([name], (f"{name}-{i}" for i in count(2))) if x not in taken)


def number(x: float) -> str:
    """As a file holds it; three digits are enough of what is chosen."""
    return f"{x:.3g}"
