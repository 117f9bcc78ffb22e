"""One mutant against the tests, in a copy of the project that nobody else looks at."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from .mutants import Mutant

#: The folders beside ``package`` that become parts of it.
HOUSES = ("golden", "hdl", "testbenches")

_NOT_COPIED = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "cardcage-out", "build")

#: Tests of whole machines and of what listens to them, for those that the file's own tests let
#: live.  Not those that make mutants themselves: they look for the right text.
BEYOND: Mapping[str, Sequence[str]] = {
    "golden": ("tests/hdl/backplane/test_command_words_document.py", "tests/golden",
               "tests/machine/test_random_lists.py"),
    "hdl": ("tests/hdl/test_cycle_constants.py", "tests/hdl/test_machine.py",
            "tests/machine/test_random_lists.py", "tests/machine/test_frame_tags.py",
            "tests/machine/interlaces/test_interlace_in_squares.py",
            "tests/testbenches/engines/test_activity_record.py"),
    "testbenches": ("tests/testbenches",),
}
_NEVER = ("tests/machine/test_mutants.py", "tests/machine/test_hard_cases_mutants.py")


def own_tests(root: Path, file: str) -> list[str]:
    """``hdl/video/x.py`` → ``tests/hdl/video/test_x.py``; where there is none, all tests of its
    folder and those in ``tests/hdl`` that import it, or else those of the next folder above."""
    place = Path(file)
    folder = Path("tests") / place.parent
    if (root / (mirror := folder / f"test_{place.name}")).is_file():
        return [mirror.as_posix()]
    module = re.compile(r"cardcage\." + re.escape(".".join(place.with_suffix("").parts)) + r"\b")
    found = [test.relative_to(root) for test in sorted((root / folder.parts[0] / folder.parts[1])
                                                       .rglob("test_*.py"))
             if module.search(test.read_text(encoding="utf-8"))]
    if len(folder.parts) > 2 and (root / folder).is_dir():  # a wing, not all of them
        found = [folder, *(test for test in found if folder not in test.parents)]
    return [test.as_posix() for test in found or [
        next(above for above in (folder, *folder.parents) if (root / above).is_dir())]]


@dataclass(frozen=True)
class Outcome:
    """``passed``, or ``why`` not, and which tests that takes: the first that failed, or all."""

    passed: bool
    why: str = ""
    failed: tuple[str, ...] = ()


class Copy:
    """A copy of the project in ``folder``, which its tests import as ``cardcage``."""

    def __init__(self, root: Path, folder: Path) -> None:
        self.root = folder / "project"
        shutil.copytree(root, self.root, ignore=_NOT_COPIED)
        self._path = folder / "path"
        package = self._path / "cardcage"
        package.mkdir(parents=True)
        for source in (*(self.root / "package").iterdir(), *(self.root / name for name in HOUSES)):
            (package / source.name).symlink_to(source)
        self._cache = folder / "models"
        # Cases that others stand for, too, where the project's tests know of such.
        self._every = ["--every"] * (root / "tests/library/suite").is_dir()

    def run_mutant(self, mutant: Mutant, tests: Iterable[str], limit: float) -> Outcome:
        """The tests with the mutant in its place; afterwards the copy is as before."""
        file = self.root / mutant.file
        right = file.read_bytes()
        try:
            self._write(file, mutant.of(right))
            return self.run(tests, limit)
        finally:
            self._write(file, right)

    def run(self, tests: Iterable[str], limit: float) -> Outcome:
        """The tests until the first that fails; whoever takes more than ``limit`` seconds fails."""
        tests = tuple(tests)
        with subprocess.Popen(
                [sys.executable, "-m", "pytest", *self._every, "-x", "-q", "-p",
                 "no:cacheprovider", "--tb=no", *(f"--ignore={test}" for test in _NEVER), *tests],
                cwd=self.root, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                env=os.environ | {"PYTHONPATH": str(self._path),
                                  "CARDCAGE_CACHE": str(self._cache)},
                start_new_session=True) as process:
            try:
                said, _ = process.communicate(timeout=limit)
            except subprocess.TimeoutExpired:
                return Outcome(False, "no end in time", tests)
            finally:
                # What the tests have started ends with them.
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
        if not process.returncode:
            return Outcome(True)
        if found := re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", said, re.MULTILINE):
            return Outcome(False, found[1], (found[1],))
        return Outcome(False, said.strip()[-200:], tests)

    @staticmethod
    def _write(file: Path, text: bytes) -> None:
        file.write_bytes(text)
        # Python knows what it has compiled by the seconds and the size of the source alone.
        for compiled in (file.parent / "__pycache__").glob(f"{file.stem}.*.pyc"):
            compiled.unlink()
