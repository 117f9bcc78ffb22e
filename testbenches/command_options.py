"""What the values of command-line options mean: sizes and precisions."""

from __future__ import annotations

import re
from typing import Any

import click

from ..golden.configuration import MAXIMUM_SIZE
from ..golden.fixed import MAX_FRACTION_BITS


class Size(click.ParamType):
    """``640x480`` as (640, 480)."""

    name = "WxH"

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> tuple[int, int]:
        match = re.fullmatch(r"([0-9]{1,9})[xX]([0-9]{1,9})", value.strip())
        if match is None:
            self.fail(f"{value!r} is not a width and a height such as 64x64", param, ctx)
        width, height = int(match[1]), int(match[2])
        for field, pixels in (("width", width), ("height", height)):
            if not 1 <= pixels <= MAXIMUM_SIZE:
                self.fail(f"{value!r}: {field} {pixels} is not from 1 to {MAXIMUM_SIZE}", param,
                          ctx)
        return width, height


class FractionBits(click.ParamType):
    """A number of bits, or ``exact``."""

    name = "N|exact"

    def convert(self, value: Any, param: click.Parameter | None,
                ctx: click.Context | None) -> int | str:
        if value == "exact":
            return "exact"
        if not re.fullmatch(r"[0-9]{1,9}", value) or int(value) > MAX_FRACTION_BITS:
            self.fail(f"{value!r} is neither 'exact' nor a whole number from 0 to "
                      f"{MAX_FRACTION_BITS}", param, ctx)
        return int(value)
