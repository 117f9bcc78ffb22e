"""How every command ends: one line for an error, and the right exit status."""

from __future__ import annotations

import importlib
import os
import shlex
import sys
import traceback
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any, NoReturn

import click

from ...golden.specification.errors import InputError
from ..support.any_characters import any_characters, readable
from ..support.interruption import Interrupted, interruptible
from ..support.machine_error import MachineError

#: The picture differs, or the machine delivered none.
EXIT_DIFFERENT = 1
#: The input or the system is at fault.
EXIT_WRONG_INPUT = 2

_OUTPUT = "standard output"

#: An environment variable: if set, an error that nobody foresaw shows where it came from.
TRACEBACK_VARIABLE = "CARDCAGE_TRACEBACK"


class OneLineErrors(click.Command):
    """A command that ends with one line on the error output where it cannot go on.

    ``MachineError`` ends it with status 1, whatever else is raised with 2: ``InputError`` and
    ``click.ClickException``, what the system refuses (also the output, full or closed), and what
    nobody foresaw.  One that is interrupted ends with the signal's status, and says what it kept
    where it kept something.  ``obj`` of the context is the command line as it was typed.
    """

    def main(self, args: Sequence[str] | None = None, prog_name: str | None = None,
             complete_var: str | None = None, standalone_mode: bool = True, **extra: Any) -> Any:
        """Run a command; ends the program unless ``standalone_mode`` is off."""
        words = list(sys.argv[1:] if args is None else args)
        extra.setdefault("obj", readable(shlex.join(["cardcage", *words])))
        if not standalone_mode:
            return super().main(words, prog_name, complete_var, standalone_mode=False, **extra)
        any_characters(sys.stdout, sys.stderr)
        try:
            with interruptible():
                if sys.stdout is None:
                    raise InputError(f"{_OUTPUT}: it is closed")
                try:
                    # Without standalone mode click hands back what --help or ctx.exit() asked for.
                    status = super().main(words, prog_name, complete_var, standalone_mode=False,
                                          **extra)
                except SystemExit:  # click's own end, status 1, where nobody reads the output
                    raise InputError(f"{_OUTPUT}: nobody reads it any more") from None
                sys.stdout.flush()  # at the end of the program it would be too late for a status
                sys.exit(status)
        except Interrupted as interruption:
            # Of hardware that was made and is not elaborated any more nobody wants to hear.
            warnings.simplefilter("ignore")
            for note in getattr(interruption, "__notes__", ()):
                _say(f"cardcage: interrupted: {_one_line(note)}")
            sys.exit(interruption.status)
        except click.ClickException as error:
            _fail(error.format_message(), EXIT_WRONG_INPUT)
        except InputError as error:
            _fail(str(error), EXIT_WRONG_INPUT)
        except MachineError as error:
            _fail(str(error), EXIT_DIFFERENT)
        except Exception as error:
            _fail(_unforeseen(error), EXIT_WRONG_INPUT)


class CommandGroup(OneLineErrors, click.Group):
    """A group of such commands, each of which is loaded when it is asked for.

    ``modules``  of each command that module, beside this one, that has it: ``check-verilog`` as
                 ``check_verilog_command``
    """

    def __init__(self, *args: Any, modules: Mapping[str, str], **settings: Any) -> None:
        super().__init__(*args, **settings)
        self._modules = modules
        # Nothing but their names, of which click suggests one for a word that is none.
        self.commands = {name: click.Command(name) for name in modules}

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self._modules:
            return None
        module = importlib.import_module(self._modules[cmd_name], __package__)
        command: click.Command = getattr(module, f"{cmd_name.replace('-', '_')}_command")
        return command


def warn(message: str) -> None:
    """One line on the error output."""
    _say(f"cardcage: warning: {_one_line(message)}")


def _fail(message: str, status: int) -> NoReturn:
    _say(f"cardcage: error: {_one_line(message)}")
    _give_up_unwritable(sys.stdout, sys.stderr)
    sys.exit(status)


def _say(line: str) -> None:
    # Where even the error output is full or closed, the status is all that can be said.
    with suppress(OSError):
        click.echo(line, err=True)


def _unforeseen(error: Exception) -> str:
    """A line for what is neither wrong input nor a machine's fault, as far as anybody knew."""
    if os.environ.get(TRACEBACK_VARIABLE):
        _say("".join(traceback.format_exception(error)).rstrip())
    if isinstance(error, OSError) and error.strerror:
        place = _OUTPUT if _while_printing(error) else error.filename
        return error.strerror if place is None else f"{place}: {error.strerror}"
    return (f"{type(error).__name__}: {error} (set {TRACEBACK_VARIABLE}=1 to see where, and report "
            "it, please)")


def _while_printing(error: Exception) -> bool:
    *_, (frame, _) = traceback.walk_tb(error.__traceback__)
    return frame.f_globals["__name__"].partition(".")[0] in ("click", "rich") or (
        frame.f_globals is globals())


def _give_up_unwritable(*outputs: Any) -> None:
    # Python would try once more to write what is left when the program ends, fail, and change
    # the status.
    for output in outputs:
        try:
            output.flush()
        except OSError:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, output.fileno())
            os.close(nowhere)
        except (AttributeError, ValueError):
            continue


def _one_line(message: str) -> str:
    return " ".join(message.split())
