"""Do the tests notice a wrong program?  ``python -m testbenches.studies.mutation_campaign``."""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue

import click

from cardcage.testbenches.support.atomic_output import atomic_file
from cardcage.testbenches.support.progress import step_bar
from cardcage.testbenches.support.text_table import TextTable

from .mutation.campaign_trial import BEYOND, Copy, Outcome, own_tests
from .mutation.equivalent_mutants import EQUIVALENT, Equivalent
from .mutation.mutants import Mutant, mutants_of

ROOT = Path(__file__).parents[2]
KILLED, SURVIVED, SAME = "killed", "survived", "equivalent"


def sample(root: Path, folders: Sequence[str], count: int, seed: int) -> list[Mutant]:
    """``count`` of the mutants of all files below ``folders``, the same for the same seed.

    A larger sample begins with the smaller one, and a change of a line changes the draw of that
    line's mutants only.
    """
    files = sorted({path.relative_to(root).as_posix() for folder in folders
                    for path in ([root / folder] if (root / folder).is_file() else
                                 (root / folder).rglob("*.py"))})
    found = [mutant for file in files for mutant in mutants_of(root, file)]
    found.sort(key=lambda mutant: hashlib.sha256(f"{seed}: {mutant.key}".encode()).digest())
    return found[:count]


@dataclass
class Results:
    """What was found, in a file that is whole after every mutant.

    ``verdicts``  key of a mutant → killed or survived, and the test that told
    ``clean``     tests that killed one, and that the right program passes
    """

    verdicts: dict[str, tuple[str, str]]
    clean: set[str]
    file: Path | None

    @classmethod
    def read(cls, file: Path | None) -> Results:
        if file is None or not file.exists():
            return cls({}, set(), file)
        kept = json.loads(file.read_text(encoding="utf-8"))
        return cls({key: (verdict, told) for key, (verdict, told) in kept["verdicts"].items()},
                   set(kept["clean"]), file)

    def write(self) -> None:
        if self.file is not None:
            with atomic_file(self.file, "--resume") as temporary:
                temporary.write_text(json.dumps(
                    {"clean": sorted(self.clean), "verdicts": self.verdicts}, indent=1,
                    ensure_ascii=False) + "\n", encoding="utf-8")

    def verdict(self, mutant: Mutant, known: Sequence[Equivalent]) -> str:
        if is_equivalent(mutant, known):
            return SAME
        return self.verdicts[mutant.key][0]


def is_equivalent(mutant: Mutant, known: Sequence[Equivalent]) -> bool:
    return any((mutant.file, mutant.text, mutant.change) == same[:3] for same in known)


def run_campaign(root: Path, mutants: Sequence[Mutant], results: Results, *,
                 known: Sequence[Equivalent] = EQUIVALENT, jobs: int = 1, patience: float = 600.0,
                 own: bool = False,
                 begin: Callable[[str], None] = lambda doing: None) -> None:
    """Runs those that have no verdict yet, ``jobs`` at a time, each in a copy of ``root``.

    ``own``: against the tests of its file only, not those of whole machines.  Tests that take
    ``patience`` seconds have no end.  Raises ``RuntimeError`` where a test that kills a mutant
    fails of the right program, too.
    """
    waiting = [mutant for mutant in mutants
               if mutant.key not in results.verdicts and not is_equivalent(mutant, known)]
    with tempfile.TemporaryDirectory() as folder, ExitStack() as at_end:
        copies: SimpleQueue[Copy] = SimpleQueue()
        for job in range(min(jobs, len(waiting))):
            copies.put(Copy(root, Path(folder) / str(job)))

        def trial(mutant: Mutant) -> Outcome:
            copy = copies.get()
            try:
                begin(f"{mutant.file}:{mutant.line}")
                stages = _stages(copy.root, mutant.file)[:1 if own else None]
                return _trial(copy, mutant, stages, results, patience)
            finally:
                copies.put(copy)

        pool = ThreadPoolExecutor(max(1, jobs))
        at_end.callback(pool.shutdown, cancel_futures=True)
        trials = {pool.submit(trial, mutant): mutant for mutant in waiting}
        for done in as_completed(trials):
            outcome = done.result()
            results.verdicts[trials[done].key] = (SURVIVED if outcome.passed else KILLED,
                                                  outcome.why)
            results.write()


def _trial(copy: Copy, mutant: Mutant, stages: Sequence[Sequence[str]], results: Results,
           patience: float) -> Outcome:
    """The tests of one stage after the other, until some fail."""
    for tests in stages:
        outcome = copy.run_mutant(mutant, tests, patience)
        if not outcome.passed:
            if not results.clean.issuperset(outcome.failed):
                clean = copy.run(outcome.failed, patience)
                if not clean.passed:
                    raise RuntimeError(f"{clean.why}: fails without a mutant")
                results.clean.update(outcome.failed)
            break
    return outcome


def _stages(root: Path, file: str) -> list[list[str]]:
    """The tests of the file, and those of whole machines."""
    beyond = [test for test in BEYOND.get(file.partition("/")[0], ()) if (root / test).exists()]
    return [own_tests(root, file), *([beyond] if beyond else [])]


def report(mutants: Sequence[Mutant], results: Results,
           known: Sequence[Equivalent] = EQUIVALENT) -> str:
    """How many of each file, then the survivors."""
    verdicts = [(mutant, results.verdict(mutant, known)) for mutant in mutants]
    counts = Counter((mutant.file, verdict) for mutant, verdict in verdicts)
    total = Counter(verdict for _, verdict in verdicts)
    columns = (KILLED, SURVIVED, SAME)
    rows = [(file, *(str(counts[file, verdict]) for verdict in columns))
            for file in sorted({mutant.file for mutant in mutants})]
    rows.append(("all", *(str(total[verdict]) for verdict in columns)))
    table = TextTable(f"{len(mutants)} mutants", ("file", *columns), tuple(rows))
    return "\n".join([table.text(), *(f"{mutant.file}:{mutant.line}: survived: {mutant.change}"
                                      for mutant, verdict in verdicts if verdict == SURVIVED)])


@click.command()
@click.option("--sample", "count", type=click.IntRange(1), default=60, show_default=True,
              help="How many mutants.")
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True)
@click.option("--folder", "folders", multiple=True, default=("hdl", "golden"), show_default=True,
              help="Of what; a file, too.  May be given several times.")
@click.option("--jobs", type=click.IntRange(1), default=1, show_default=True,
              help="At the same time.")
@click.option("--resume", type=click.Path(dir_okay=False, path_type=Path),
              help="Results are kept in this file, and those that it has are not repeated.")
@click.option("--again", is_flag=True, help="But for the survivors, when there are new tests.")
@click.option("--own", is_flag=True, help="Only a file's own tests: quicker.")
def main(count: int, seed: int, folders: Sequence[str], jobs: int, resume: Path | None,
         again: bool, own: bool) -> None:
    """Make one point of a file wrong, in a copy of the project, and run the tests of that file,
    then those of whole machines: some should fail.  A mutant whose tests do not end is killed, too.

    Exit status 1 where one survives: add a test, or say in equivalent_mutants.py why it does the
    same as the right program.

    \b
    Examples:
      python -m testbenches.studies.mutation_campaign --sample 60 --seed 1 --jobs 2
      python -m testbenches.studies.mutation_campaign --folder hdl/video --sample 1000
      python -m testbenches.studies.mutation_campaign --own --resume campaign.json
      python -m testbenches.studies.mutation_campaign --resume campaign.json --again
    """
    for folder in folders:
        if not (ROOT / folder).exists():
            raise click.BadParameter(f"there is no {folder} in {ROOT}", param_hint="--folder")
    mutants = sample(ROOT, folders, count, seed)
    results = Results.read(resume)
    if again:
        results.verdicts = {key: kept for key, kept in results.verdicts.items()
                            if kept[0] != SURVIVED}
    with step_bar(len(mutants)) as begin:
        run_campaign(ROOT, mutants, results, jobs=jobs, own=own, begin=begin)
    click.echo(report(mutants, results))
    sys.exit(any(results.verdict(mutant, EQUIVALENT) == SURVIVED for mutant in mutants))


if __name__ == "__main__":
    main(prog_name="python -m testbenches.studies.mutation_campaign")
