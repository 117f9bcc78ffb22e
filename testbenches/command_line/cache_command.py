"""``cardcage cache``."""

from __future__ import annotations

import click

from ...golden.specification.errors import InputError
from ..support.cache import cache_folder, cache_size, clear_cache


@click.command(name="cache")
@click.option("--clear", is_flag=True, help="Remove all of it; what others put there stays.")
def cache_command(clear: bool) -> None:
    """Show where compiled models and long measurements are kept, or remove them.

    A model is compiled once for each machine, a machine placed and routed once; CARDCAGE_CACHE
    names another folder.

    \b
    Examples:
      cardcage cache
      cardcage cache --clear
    """
    if clear:
        try:
            freed = clear_cache()
        except OSError as error:
            raise InputError(f"cache: {error.filename} cannot be removed ({error.strerror})"
                             ) from None
        click.echo(f"{freed / 1e6:,.1f} MB removed from {cache_folder()}")
    else:
        click.echo(f"{cache_size() / 1e6:,.1f} MB in {cache_folder()}")

