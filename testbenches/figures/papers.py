"""The papers whose figures can be redrawn, and how each is."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from ...golden.specification.errors import InputError
from ..support.text_table import TextTable
from . import cox_hanrahan_facts, figure_tables
from .blazek import facts as blazek_facts
from .blazek import figure_tables as blazek_tables
from .blazek import page as blazek_page
from .blazek.blazek import BlazekOptions, redraw_blazek
from .cox_hanrahan import FiguresOptions, redraw_cox_hanrahan
from .cox_hanrahan_page import FIGURE_FILES, write_cox_hanrahan
from .ellsworth import facts, page
from .ellsworth import figure_tables as ellsworth_tables
from .ellsworth.ellsworth import EllsworthOptions, redraw_ellsworth


@dataclass(frozen=True)
class Paper:
    """``options``: a dataclass of what can be asked for, whose ``jobs`` are the steps of the work.
    ``redraw`` takes it, the command line and a function to tell each step to; of what it returns
    the others tell, ``write`` in ``files``."""

    options: type[Any]
    redraw: Callable[[Any, str | None, Callable[[str], None]], Any]
    files: Sequence[str]
    write: Callable[[Any, Path], None]
    facts: Callable[[Any], dict[str, Any]]
    headline: Callable[[Any], list[str]]
    tables: Callable[[Any], list[TextTable]]

    def chosen(self, paper: str, asked: Mapping[str, Any]) -> Any:
        """The options that were asked for; ``InputError`` for one that the paper does not have."""
        known = {field.name for field in fields(self.options)}
        for name in asked:
            if name not in known:
                word = "model" if name == "models" else name
                raise InputError(f"--{word}: is not for {paper}; leave it out")
        return self.options(**asked)


PAPERS = {
    cox_hanrahan_facts.PAPER: Paper(
        FiguresOptions, redraw_cox_hanrahan, FIGURE_FILES, write_cox_hanrahan,
        cox_hanrahan_facts.cox_hanrahan_facts, figure_tables.headline, figure_tables.tables),
    facts.PAPER: Paper(
        EllsworthOptions, redraw_ellsworth, page.FIGURE_FILES, page.write_ellsworth,
        facts.ellsworth_facts, ellsworth_tables.headline, ellsworth_tables.tables),
    blazek_facts.PAPER: Paper(
        BlazekOptions, redraw_blazek, blazek_page.FIGURE_FILES, blazek_page.write_blazek,
        blazek_facts.blazek_facts, blazek_tables.headline, blazek_tables.tables),
}
