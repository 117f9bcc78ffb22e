"""What all tests share: ``library/`` is importable, and what tests measure is shown at the end."""

import sys
from pathlib import Path

import pytest

LIBRARY = Path(__file__).parent / "library"
if str(LIBRARY) not in sys.path:
    sys.path.insert(0, str(LIBRARY))
pytest.register_assert_rewrite(*(path.stem for path in LIBRARY.iterdir() if path.stem[0] != "_"))

MEASURED = "measured"


def pytest_terminal_summary(terminalreporter):
    """A line for each ``record_property("measured", text)`` of a test that passed."""
    lines = sorted(text for report in terminalreporter.stats.get("passed", [])
                   for name, text in report.user_properties if name == MEASURED)
    if lines:
        terminalreporter.section(MEASURED)
        for line in lines:
            terminalreporter.line(line)
