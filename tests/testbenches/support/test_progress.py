"""What the bar of points shows on terminals of several widths."""

import io
import re

import pytest
from rich.console import Console

from cardcage.testbenches.support import progress


@pytest.mark.parametrize("width", [80, 100, 109, 110, 140])
def test_the_time_left_is_whole(monkeypatch, width):
    """However long the words on the last point are, and in one line."""
    shown = io.StringIO()
    monkeypatch.setattr(progress, "Console", lambda stderr: Console(
        file=shown, force_terminal=True, width=width, color_system=None, legacy_windows=False))
    with progress.points_bar(60_000) as found:
        found(59_999, "a_rather_long_scene[1].scene 1024x1024 on 16x(PMM)/4x4@elements, exact " * 2)
    [line] = {line for line in re.split(r"[\r\n]|\x1b\[[0-9?]*[A-Za-z]", shown.getvalue())
              if "59999 of 60000 points" in line and "a_rather" in line}
    assert re.search(r"about (-:--:--|\d:\d\d:\d\d) left a_rather", line)
    assert len(line.rstrip()) <= width and "…" in line
    assert ("elapsed" in line) == (width >= 110)
