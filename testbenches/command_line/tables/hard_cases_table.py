"""The hard cases, for people and for programs."""

from __future__ import annotations

import json
from typing import Any

from rich.console import Console
from rich.table import Table

from ....golden.hard_cases.catalogue import HARD_CASES
from ....golden.scene_argument import HardCaseScene


def _listed() -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    for case in HARD_CASES.values():
        display_list = case.make()
        rows.append({
            "name": HardCaseScene(case.name).name,
            "mistake": case.mistake,
            "width": display_list.width,
            "height": display_list.height,
            "triangles": display_list.triangles,
            "expected": [expectation.says for expectation in case.expectations],
        })
    return rows


def hard_cases_json() -> str:
    """A list of objects: name, mistake, width, height, triangles, and what is expected."""
    return json.dumps(_listed(), indent=2, ensure_ascii=False)


def hard_cases_text() -> str:
    """Plain lines: name, size and triangles; below, what a naive implementation does wrong."""
    return "\n".join(
        f"{case['name']:32} {case['width']:>4}x{case['height']:<4} {case['triangles']:5} triangles"
        f"\n    {case['mistake']}" for case in _listed())


def hard_cases_table() -> None:
    """The same as a table on the terminal."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 1, 0))
    table.add_column("hard case", style="bold", no_wrap=True)
    table.add_column("size", justify="right")
    table.add_column("triangles", justify="right")
    table.add_column("a naive implementation …")
    for case in _listed():
        table.add_row(str(case["name"]), f"{case['width']}x{case['height']}",
                      f"{case['triangles']:,}", str(case["mistake"]))
    console = Console()
    console.print(table)
    console.print("Draw one: cardcage render hard:sliver-fan", highlight=False)
