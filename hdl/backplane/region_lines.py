"""The lines by which the controller deals the regions of the screen out."""

from amaranth.lib import wiring
from amaranth.lib.wiring import Out

from ...golden.specification.configuration import MachineConfiguration

__all__ = ["RegionLines"]


class RegionLines(wiring.Signature):
    """To every processing element, and to the video scan generator; nobody answers.

    Each keeps two tables: a picture is drawn, shown and read back by the one it was begun with,
    while the other is filled.  ``Out`` is from the controller.

    Members
    -------
    valid: Out(1)
        In this clock region ``column``, ``row`` of table ``bank`` is given away.  A table comes
        whole, row by row, or is never used.
    bank: Out(1)
        Never the table in use.
    column: Out(column_bits), row: Out(row_bits)
        Which region.
    element: Out(element_bits), slot: Out(table_bits)
        Its processing element, and its place there: how many lower regions that one has.
    table: Out(1)
        The table in use: to processing elements that of the picture last drawn, to the scan
        generator that of the picture shown.

    Ellsworth 1994: the assignment that is sent to all processors before a frame.
    """

    def __init__(self, configuration: MachineConfiguration):
        regions = configuration.dealt_regions
        super().__init__({
            "valid": Out(1),
            "bank": Out(1),
            "column": Out(regions.column_bits),
            "row": Out(regions.row_bits),
            "element": Out(configuration.element_bits),
            "slot": Out(configuration.table_bits),
            "table": Out(1),
        })
