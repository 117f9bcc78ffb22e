"""The one exception for everything a user can put right."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input: a file, a name, a card order or a number that cannot be used.

    The message is one line that names the file or option, the field and the
    remedy.  The command line prints it and exits with status 2.

    >>> import cardcage
    >>> cardcage.make_display_list("nowhere.obj")
    Traceback (most recent call last):
    cardcage.golden.specification.errors.InputError: nowhere.obj: file: no such file; check the path
    """
