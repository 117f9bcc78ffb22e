"""File names of any bytes: printed as they are, and readable in reports."""

from __future__ import annotations

import codecs
import io

_ERRORS = "cardcage.any"


def any_characters(*outputs: object) -> None:
    """From now on these text streams take every string.

    A file name that is no UTF-8 comes out byte for byte; a character that the terminal's encoding
    does not have, as its number.
    """
    for output in outputs:
        if isinstance(output, io.TextIOWrapper):
            output.reconfigure(errors=_ERRORS)


def readable(text: str) -> str:
    """The text with its undecodable bytes as numbers: for files, which are UTF-8."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _replaced(error: UnicodeError) -> tuple[str | bytes, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    try:
        return codecs.lookup_error("surrogateescape")(error)
    except UnicodeError:
        return codecs.lookup_error("backslashreplace")(error)


codecs.register_error(_ERRORS, _replaced)
