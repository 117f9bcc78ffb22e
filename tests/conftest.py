"""What tests measure is shown at the end of a run, whoever ran them: ``record_property``."""

MEASURED = "measured"


def pytest_terminal_summary(terminalreporter):
    """A line for each ``record_property("measured", text)`` of a test that passed."""
    lines = sorted(text for report in terminalreporter.stats.get("passed", [])
                   for name, text in report.user_properties if name == MEASURED)
    if lines:
        terminalreporter.section(MEASURED)
        for line in lines:
            terminalreporter.line(line)
