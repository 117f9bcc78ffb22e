"""The one exception for everything a user can put right."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input: a file, a name, a card order or a number that cannot be used.

    The message is one line that names the file or option, the field and the
    remedy.  The command line prints it and exits with status 2.
    """
