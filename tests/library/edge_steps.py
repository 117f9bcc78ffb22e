"""Edges followed down their rows as hardware does, in registers of few bits."""

from cardcage.golden.reference.triangle_setup import CarriedEdges, Edges
from cardcage.golden.specification import fixed_point

#: No register of these tests is wider.
UNBOUNDED = 64


def stepped_columns(edges: Edges, triangle: int, rows: int, column_bits: int,
                    remainder_bits: int = UNBOUNDED, sum_bits: int = UNBOUNDED) -> list[int]:
    """The column on each of ``rows`` rows, by quotient and remainder."""
    step = fixed_point.wrap(int(edges.column_step[triangle]), column_bits)
    column = fixed_point.wrap(int(edges.column[triangle]), column_bits)
    remainder, remainder_step, denominator = (
        fixed_point.wrap(int(part[triangle]), remainder_bits)
        for part in (edges.remainder, edges.remainder_step, edges.denominator))
    columns = []
    for _ in range(rows):
        columns.append(fixed_point.to_signed(column, column_bits))
        total = fixed_point.wrap(remainder + remainder_step, sum_bits)
        carry = total >= denominator
        remainder = fixed_point.wrap(total - denominator * carry, remainder_bits)
        column = fixed_point.wrap(column + step + carry, column_bits)
    return columns


def carried_columns(carried: CarriedEdges, triangle: int, rows: int,
                    column_bits: int) -> list[int]:
    """The column on each of ``rows`` rows, as a machine that carries the edge finds it."""
    fraction_bits = carried.word_bits - column_bits
    start, step = int(carried.start[triangle]), int(carried.step[triangle])
    return [fixed_point.floor_shift(fixed_point.to_signed(fixed_point.wrap(start + row * step,
    carried.word_bits),
                                              carried.word_bits), fraction_bits)
            for row in range(rows)]
