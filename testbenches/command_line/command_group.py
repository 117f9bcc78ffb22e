"""How every command ends: one line for an error, and the right exit status."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import click

from ...golden.specification.errors import InputError
from ..frames.responses import MachineError
from ..support.interruption import Interrupted, interruptible

EXIT_DIFFERENT = 1
EXIT_WRONG_INPUT = 2


class OneLineErrors(click.Command):
    """A command that raises ``InputError``, ``MachineError`` or ``click.ClickException``.

    Each becomes one line on the error output, without a traceback.  ``obj`` of the context is
    the command line as it was typed.
    """

    def main(self, args: Sequence[str] | None = None, prog_name: str | None = None,
             complete_var: str | None = None, standalone_mode: bool = True, **extra: Any) -> Any:
        """Run a command; ends the program unless ``standalone_mode`` is off."""
        words = list(sys.argv[1:] if args is None else args)
        extra.setdefault("obj", shlex.join(["cardcage", *words]))
        if not standalone_mode:
            return super().main(words, prog_name, complete_var, standalone_mode=False, **extra)
        try:
            with interruptible():
                # Without standalone mode click hands back what --help or ctx.exit() asked for.
                sys.exit(super().main(words, prog_name, complete_var, standalone_mode=False,
                                      **extra))
        except Interrupted as interruption:
            sys.exit(interruption.status)
        except click.ClickException as error:
            _fail(error.format_message(), EXIT_WRONG_INPUT)
        except InputError as error:
            _fail(str(error), EXIT_WRONG_INPUT)
        except MachineError as error:
            _fail(str(error), EXIT_DIFFERENT)


class CommandGroup(OneLineErrors, click.Group):
    """A group of such commands."""


def warn(message: str) -> None:
    """One line on the error output."""
    click.echo(f"cardcage: warning: {_one_line(message)}", err=True)


def _fail(message: str, status: int) -> NoReturn:
    click.echo(f"cardcage: error: {_one_line(message)}", err=True)
    sys.exit(status)


def _one_line(message: str) -> str:
    return " ".join(message.split())
