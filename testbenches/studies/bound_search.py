"""How far the datapath's errors go: ``python -m testbenches.studies.bound_search``.

Prints, for depth and for colour and at several numbers of fraction bits, the error bound and the
worst carried value that a search finds, and what is stored on that triangle at worst.
"""

from __future__ import annotations

import sys
from math import ceil

import click
from rich.console import Console
from rich.progress import track

from cardcage.golden.precision.worst_case_search import (
    INTERPOLANTS,
    Interpolant,
    WorstCase,
    find_worst,
    stored_errors,
)
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.fixed_point import MAX_FRACTION_BITS
from cardcage.testbenches.command_line.command_options import Size

_HEADING = (f"{'':6} {'F':>2}  {'bound':>10}  {'worst':>10}  {'of bound':>8}  {'seed':>4}   "
            "stored at worst (may be)")


def line(case: WorstCase) -> str:
    """One row of the table."""
    stored = int(abs(stored_errors(case)[0]).max())
    return (f"{case.interpolant:6} {case.fraction_bits:2}  {float(case.bound):10.4g}  "
            f"{float(case.error):10.4g}  {case.ratio:8.4f}  {case.seed:4}   "
            f"{stored} ({ceil(case.bound)})")


@click.command()
@click.option("--size", type=Size(), metavar="WxH", default="512x512", show_default=True)
@click.option("--sub-bits", type=click.IntRange(1, 8), default=8, show_default=True)
@click.option("--depth-bits", type=click.IntRange(2, 32), default=24, show_default=True)
@click.option("--fraction-bits", "chosen", type=click.IntRange(0, MAX_FRACTION_BITS),
              multiple=True, default=(0, 4, 9, 12, 16, 24, 32, 45), show_default=True,
              help="May be given several times.")
@click.option("--seeds", type=click.IntRange(1), default=8, show_default=True,
              help="Searches for each row; the worst is shown.")
def main(size: tuple[int, int], sub_bits: int, depth_bits: int, chosen: tuple[int, ...],
         seeds: int) -> None:
    """Search for the triangle on which the datapath errs most, and compare with the bound.

    Exit status 1 where the bound is exceeded.

    \b
    Examples:
      python -m testbenches.studies.bound_search
      python -m testbenches.studies.bound_search --size 640x480 --fraction-bits 9 --seeds 100
    """
    def worst(interpolant: Interpolant, fraction_bits: int) -> WorstCase:
        return max((find_worst(width=size[0], height=size[1], interpolant=interpolant,
                               fraction_bits=fraction_bits, seed=seed, sub_bits=sub_bits,
                               depth_bits=depth_bits) for seed in range(seeds)),
                   key=lambda case: case.ratio)

    console = Console(stderr=True)
    rows = [(interpolant, bits) for interpolant in INTERPOLANTS for bits in chosen]
    try:
        cases = [worst(*row) for row in track(rows, "searching", console=console, transient=True,
                                              disable=not console.is_terminal)]
    except InputError as error:
        raise click.UsageError(str(error)) from None
    click.echo(f"{size[0]}x{size[1]}, {sub_bits} sub-pixel bits, {depth_bits} depth bits; "
               "errors in LSB")
    click.echo(_HEADING)
    for case in cases:
        click.echo(line(case))
    if any(abs(case.error) > case.bound for case in cases):
        click.echo("the bound is exceeded", err=True)
        sys.exit(1)


if __name__ == "__main__":
    main()
