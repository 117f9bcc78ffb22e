"""The list of built-in scenes, for people and for programs."""

from __future__ import annotations

import json

from rich.console import Console
from rich.table import Table

from ....golden.scene_argument import list_scenes


def scenes_json() -> str:
    """A list of objects: name, description, triangles, parameters with default and range."""
    return json.dumps([
        {
            "name": scene.name,
            "description": scene.description,
            "triangles": scene.triangles,
            "parameters": [
                {"name": parameter.name, "default": parameter.default, "low": parameter.low,
                 "high": parameter.high, "description": parameter.description}
                for parameter in scene.parameters
            ],
        }
        for scene in list_scenes()
    ], indent=2, ensure_ascii=False)


def scenes_text() -> str:
    """Plain lines: name, triangles and description, the parameters below."""
    lines = []
    for scene in list_scenes():
        lines.append(f"{scene.name:12} {scene.triangles:8} triangles  {scene.description}")
        lines += [f"    {f'{parameter.name}={parameter.default}':18} {parameter.description} "
                  f"({parameter.range})" for parameter in scene.parameters]
    return "\n".join(lines)


def scenes_table() -> None:
    """The same as a table on the terminal."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 1, 0))
    table.add_column("scene", style="bold", no_wrap=True)
    table.add_column("triangles", justify="right")
    table.add_column("what it is, and its parameters with their defaults")
    for scene in list_scenes():
        about = "\n".join([scene.description, *(
            f"  {parameter.name}={parameter.default}  {parameter.description}"
            for parameter in scene.parameters)])
        table.add_row(scene.name, f"{scene.triangles:,}", about)
    console = Console()
    console.print(table)
    console.print("Draw one: cardcage render sphereflake:depth=1", highlight=False)
