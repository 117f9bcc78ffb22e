"""What shows on a terminal that something is still running."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.text import Text

#: Told how many cycles are simulated, and how many responses there were.
ProgressFunction = Callable[[int, int], None]


@contextmanager
def progress_bar(expected_cycles: int) -> Iterator[ProgressFunction | None]:
    """A function to tell the progress to; None where the error output is no terminal."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield None
        return
    with Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.completed:,.0f} cycles"),
        TimeElapsedColumn(),
        TextColumn("elapsed, about"),
        TimeRemainingColumn(),
        TextColumn("left"),
        console=console,
        transient=True,
    ) as bar:
        task = bar.add_task("simulating", total=expected_cycles)

        def report(cycles: int, responses: int) -> None:
            # The expectation is a guess: never show a bar that is full and goes on.
            bar.update(task, completed=cycles, total=max(expected_cycles, cycles * 21 // 20),
                       description="simulating" if cycles else "compiling the model, once")

        yield report


@contextmanager
def busy(description: str) -> Iterator[None]:
    """A spinner while something runs that cannot say how far it is; none where the error output
    is no terminal."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    with console.status(description):
        yield


@contextmanager
def step_bar(steps: int) -> Iterator[Callable[[str], None]]:
    """A function to call with a few words before each of about ``steps`` steps; it shows nothing
    where the error output is no terminal."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda doing: None
        return
    with Progress(BarColumn(), TextColumn("{task.completed:.0f} of {task.total:.0f}"),
                  TimeElapsedColumn(), TextColumn("{task.description}"), console=console,
                  transient=True) as bar:
        task = bar.add_task("", total=steps)
        begun = 0

        def begin(doing: str) -> None:
            nonlocal begun
            bar.update(task, completed=begun, total=max(steps, begun + 1), description=doing)
            begun += 1

        yield begin


#: Columns of a terminal that the bar of points takes beside the words on a point and the number of
#: points twice; with at least so many it has room for the time that has passed.
BAR_COLUMNS, ROOMY_COLUMNS = 49, 110


@contextmanager
def points_bar(points: int) -> Iterator[Callable[[int, str], None]]:
    """A function to tell how many more of ``points`` are there, and of which the last one was; it
    shows how long the rest takes, and nothing where the error output is no terminal.

    The words on the last point are cut to what the terminal has room for, so that the time left is
    whole at 80 columns; the time that has passed is shown on wide terminals only."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda more, last: None
        return
    roomy = console.width >= ROOMY_COLUMNS
    passed = [TimeElapsedColumn(), TextColumn("elapsed,")] if roomy else []
    with Progress(BarColumn(16), TextColumn("{task.completed:.0f} of {task.total:.0f} points"),
                  *passed, TextColumn("about"), TimeRemainingColumn(), TextColumn("left"),
                  TextColumn("{task.description}", markup=False), console=console,
                  transient=True) as bar:
        task = bar.add_task("", total=points)

        def found(more: int, last: str) -> None:
            room = console.width - BAR_COLUMNS - 2 * len(str(points)) - 17 * roomy
            words = Text(last)
            words.truncate(max(room, 0), overflow="ellipsis")
            bar.update(task, advance=more, description=words.plain)

        yield found
