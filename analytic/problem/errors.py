"""The one exception for input that cannot be used."""


class InputError(ValueError):
    """Input that names no solvable problem, told in one line.

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
        super().__init__(f"{name} = {value}: must be {allowed}; {remedy}")
