"""The one exception for input that cannot be used."""


class InputError(ValueError):
    """Input that states no solvable problem, reported in one line.

    Parameters
    ----------
    name : str
        What was given, as the user knows it (``"beam.length"``).
    value : object
        The value that was given.
    allowed : str
        What would be allowed (``"a positive finite number"``).
    remedy : str
        What to do about it.
    """

    def __init__(self, name: str, value: object, allowed: str, remedy: str) -> None:
        self._given = name, str(value), allowed, remedy
        line = f"{name} = {value}: must be {allowed}; {remedy}"
        super().__init__(" ".join(line.split()))

    def __reduce__(self) -> tuple[type["InputError"], tuple[str, str, str, str]]:
        return type(self), self._given  # so that another process can hand it back
