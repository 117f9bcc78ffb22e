"""The ranges of the picture's format, and the one check of a whole number."""

from __future__ import annotations

from .errors import InputError

MAXIMUM_SIZE = 4096
MAXIMUM_WORDS = 1 << 20  # of one memory

#: Bits of a colour channel, and of a colour: red in the low bits, then green, blue.
CHANNEL_BITS = 8
COLOR_BITS = 3 * CHANNEL_BITS

#: Field, least and greatest value, wherever a picture's format is given.
FORMAT_RANGES = (
    ("width", 1, MAXIMUM_SIZE),
    ("height", 1, MAXIMUM_SIZE),
    ("sub_bits", 1, 8),
    ("depth_bits", 2, 32),
)


def check_whole(field: str, value: object, low: int, high: int) -> None:
    """Raise ``InputError``, which begins with ``field``, unless ``value`` is a whole number from
    ``low`` to ``high``; True and False are none."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise InputError(f"{field}: {value!r} is not a whole number from {low} to {high}")
