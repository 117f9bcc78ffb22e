"""A study of precision for people: tables on a terminal, aligned lines elsewhere."""

from __future__ import annotations

from ...golden.organisations.organisation_of import organisation_of
from ...golden.precision.precision_study import PictureError
from ..fpga.place_and_route import Placement
from ..support.counted import counted
from ..support.text_table import TextTable, print_tables, tables_text
from .scene_precision import Precision, PrecisionRow

#: Stands for a figure that was not measured.
NOTHING = "-"


def tables(precision: Precision) -> list[TextTable]:
    """Errors, formats, and speed; the page shows the same."""
    depth_bits = precision.scene.display_list.depth_bits
    rows = precision.rows
    exact = precision.machine.fraction_bits
    return [
        TextTable(
            f"error of the machine against the exact picture, LSB of {depth_bits} depth bits; "
            "end to end: against the scene before it was quantised",
            ("fraction bits", "bound", "depth max", "mean", "wrong pixels", "colour max",
             "end to end: wrong", "depth max", "mean"),
            (*((f"{bits} exact" if (bits := row.point.fraction_bits) == exact else str(bits),
                str(row.point.bound), *_error(row.point.error),
                *_end_to_end(row.point.end_to_end)) for row in rows),
             ("float32 Z-buffer", NOTHING, *_error(precision.float32.error),
              *_end_to_end(precision.float32.end_to_end))),
        ),
        TextTable(
            "formats of the display list, end to end, machine exact; LSB of each line's own depth",
            ("sub-pixel bits", "depth bits", "exact from", "wrong pixels", "depth max", "mean",
             "colour max"),
            tuple((str(point.sub_bits), str(point.depth_bits), str(point.exact_fraction_bits),
                   *_end_to_end(point.end_to_end), f"{point.end_to_end.color_maximum:.1f}")
                  for point in precision.formats),
        ),
        _speeds(precision),
    ]


def _speeds(precision: Precision) -> TextTable:
    title = "speed, and one processing element on an ECP5-85k, speed grade 6"
    columns = ("fraction bits", "cycles", "frame", "fragments / clock / PE")
    rows = [(str(row.point.fraction_bits), *_speed(precision, row)) for row in precision.rows]
    if all(row.placement is None for row in precision.rows):
        reason = precision.missing_tools or "--place-and-route"
        return TextTable(title, (*columns, "area and clock"), tuple((*row, reason) for row in rows))
    return TextTable(
        title,
        (*columns, "LUT", "FF", "DSP", "BRAM", "LUT RAM", "MHz", "range", "Mfragments / s / PE"),
        tuple((*words, *_placement(row.placement), _rate(precision, row))
              for words, row in zip(rows, precision.rows, strict=True)),
    )


def precision_text(precision: Precision) -> str:
    """The study as plain lines, the columns aligned."""
    return tables_text(headline(precision), tables(precision), remarks(precision))


def precision_table(precision: Precision) -> None:
    """The same as tables on the terminal."""
    print_tables(headline(precision), tables(precision), remarks(precision))


def headline(precision: Precision) -> list[str]:
    """The verdict first."""
    machine, problems = precision.machine, precision.problems()
    width, height, *_ = organisation_of(machine).resolution
    triangles = counted(precision.scene.display_list.triangles, "triangle")
    about = (f"{precision.scene.name}: {triangles} at {width}x{height} on {machine.cards}; exact "
             f"from {machine.fraction_bits} fraction bits")
    if problems:
        return [f"FAILED: {problem}" for problem in problems] + [about]
    return [f"good: 0 LSB at exact, no bound exceeded at "
            f"{counted(len(precision.rows), 'precision')}, "
            f"{sum(row.frame is not None for row in precision.rows)} of them simulated pixel for "
            "pixel", about]


def remarks(precision: Precision) -> list[str]:
    """What the tables leave open."""
    lines = ["depth and colour errors are of the pixels that show the right primitive"]
    if any(row.frame is None for row in precision.rows):
        lines.append("frame: simulated, or as at the nearest fraction bits that were; --simulate "
                     "all simulates every one" if any(row.frame for row in precision.rows) else
                     "no frame was simulated: --engine auto does")
    if all(row.placement is None for row in precision.rows):
        lines.append(f"area and clock: {precision.missing_tools}" if precision.missing_tools else
                     "area and clock: --place-and-route measures them, minutes for each line")
    return lines


def number(value: float) -> str:
    """An error in LSB: whole if it is, with as many digits as tell something if not."""
    if value == int(value):
        return f"{int(value):,}"
    return f"{value:,.0f}" if value >= 100 else f"{value:.2g}" if value < 1 else f"{value:.1f}"


def _error(error: PictureError) -> tuple[str, ...]:
    return (number(error.depth_maximum), number(error.depth_mean), f"{error.wrong_pixels:,}",
            number(error.color_maximum))


def _end_to_end(error: PictureError) -> tuple[str, ...]:
    return f"{error.wrong_pixels:,}", number(error.depth_maximum), number(error.depth_mean)


def _speed(precision: Precision, row: PrecisionRow) -> tuple[str, ...]:
    frame = precision.frame(row)
    if frame is None:
        return NOTHING, "none", NOTHING
    return (f"{frame.cycles:,}", "simulated" if row.frame is not None else "nearest",
            f"{precision.fragments_per_clock(row) or 0:.3f}")


def _placement(placement: Placement | None) -> tuple[str, ...]:
    if placement is None:
        return (NOTHING,) * 7
    return (f"{placement.luts:,}", f"{placement.flip_flops:,}", str(placement.multipliers),
            str(placement.block_rams), str(placement.lut_rams), f"{placement.median_mhz:.1f}",
            f"{min(placement.mhz):.1f} to {max(placement.mhz):.1f}")


def _rate(precision: Precision, row: PrecisionRow) -> str:
    rate = precision.megafragments_per_second(row)
    return NOTHING if rate is None else f"{rate:.1f}"
