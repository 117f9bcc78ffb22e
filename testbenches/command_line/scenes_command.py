"""``cardcage scenes``."""

from __future__ import annotations

import sys

import click

from ...golden.scenes.scene_files.language import reference
from .tables.hard_cases_table import hard_cases_json, hard_cases_table, hard_cases_text
from .tables.scenes_table import scenes_json, scenes_table, scenes_text


@click.command(name="scenes")
@click.option("--hard", is_flag=True,
              help="The hard cases, and what a naive implementation does wrong on each.")
@click.option("--json", "as_json", is_flag=True, help="For programs: a list of objects.")
@click.option("--language", is_flag=True,
              help="The words of scene files, with what they mean and an example of each.")
def scenes_command(hard: bool, as_json: bool, language: bool) -> None:
    """List the built-in scenes, their parameters and their triangles, or the hard cases.

    \b
    Examples:
      cardcage scenes
      cardcage scenes --json
      cardcage render sphereflake:depth=1,tessellation=2
      cardcage scenes --hard
      cardcage render hard:sliver-fan
      cardcage scenes --language
      cardcage render my.scene
    """
    if language:
        click.echo(reference())
        return
    to_json, to_table, to_text = (
        (hard_cases_json, hard_cases_table, hard_cases_text) if hard
        else (scenes_json, scenes_table, scenes_text))
    if as_json:
        click.echo(to_json())
    elif sys.stdout.isatty():
        to_table()
    else:
        click.echo(to_text())

