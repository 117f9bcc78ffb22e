"""Pages of a report: templates and charts that make one file, complete in itself."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib import rc_context
from matplotlib.figure import Figure

from ..support.counted import counted

#: Stands for the page's own text colour, which follows the reader's light or dark setting.
_TEXT_COLOR = "#010203"


def page_environment() -> Environment:
    """Where the page templates are, which know ``counted``; a value that is missing is an error."""
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals["counted"] = counted
    return environment


@contextmanager
def chart_style() -> Iterator[None]:
    """Within, figures are drawn as ``svg_element`` wants them."""
    with rc_context({
        "svg.fonttype": "none", "svg.hashsalt": "cardcage", "font.family": "sans-serif",
        "font.size": 10, "text.color": _TEXT_COLOR, "axes.labelcolor": _TEXT_COLOR,
        "axes.edgecolor": _TEXT_COLOR, "xtick.color": _TEXT_COLOR, "ytick.color": _TEXT_COLOR,
    }):
        yield


def svg_element(figure: Figure, label: str) -> str:
    """The figure as an ``<svg>`` element that takes the page's text colour and holds no link.

    As HTML wants it: no prologue, no name spaces, its size left to CSS; ``label`` for those who
    do not see it.
    """
    file = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    figure.savefig(file, format="svg", transparent=True, metadata=nothing)
    document = file.getvalue()
    element = document[document.index("<svg"):]
    element = re.sub(r'\s+xmlns(:\w+)?="[^"]*"', "", element)
    head, rest = element.split(">", 1)
    head = re.sub(r'\s(width|height)="[^"]*"', "", head)
    return f'{head} role="img" aria-label="{label}">{rest}'.replace(
        _TEXT_COLOR, "currentColor").strip()
