"""What all tests share: ``library/`` is importable, some tests are marked quick, some cases stand
for all, and what tests measure is shown at the end."""

import gc
import sys
from pathlib import Path

import pytest
from hypothesis.configuration import set_hypothesis_home_dir

TESTS = Path(__file__).parent
LIBRARY = TESTS / "library"
if str(LIBRARY) not in sys.path:
    sys.path.insert(0, str(LIBRARY))
pytest.register_assert_rewrite(*(path.stem for path in LIBRARY.iterdir() if path.stem[0] != "_"))

# From whatever folder the tests are run, hypothesis keeps its examples in one.
set_hypothesis_home_dir(TESTS.parent / ".hypothesis")

# Machines are built of a million small objects that refer to one another: to look for garbage after
# each 700 of them, as Python does, takes a fifth of the tests' time.
gc.set_threshold(1_000_000, 5, 5)

#: ``pytest -m quick``: golden models, components and the structure of the house, a minute or so
#: on two cores.
QUICK = ("golden", "hdl", "test_house.py")
#: But for whole machines, whole lists through the set-up, and what tries every triangle there is.
NOT_QUICK = ("golden/precision/test_error_bound.py", "golden/cycles/test_frame_clocks.py",
             "hdl/test_machine.py", "hdl/test_shared_wires.py", "hdl/test_cycle_constants.py",
             "hdl/backplane/test_command_words_document.py",
             "hdl/triangle_setup/test_triangle_setup.py")

#: What takes longest is begun first, so that no core is left alone with it at the end.
SLOW = ("test_readme.py", "testbenches/export/test_equivalence.py", "testbenches/speed", "machine",
        "testbenches", "test_install.py")

MEASURED = "measured"


@pytest.hookimpl(optionalhook=True)  # of pytest-xdist
def pytest_xdist_make_scheduler(config, log):
    """Neighbouring tests share models and stay on one core until another core runs out of work."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)


def pytest_addoption(parser):
    parser.addoption("--every", action="store_true",
                     help="every case, in place of some that stand for all: half an hour and "
                          "more on two cores")


def pytest_report_header(config):
    return None if config.getoption("every") else "some cases stand for all; --every runs each"


@pytest.hookimpl(tryfirst=True)  # before pytest selects by marks
def pytest_collection_modifyitems(config, items):
    for item in items:
        place = item.path.relative_to(TESTS)
        if place.parts[0] in QUICK and place.as_posix() not in NOT_QUICK:
            item.add_marker(pytest.mark.quick)
    if not config.getoption("every"):
        others = [item for item in items if item.get_closest_marker("every")]
        config.hook.pytest_deselected(items=others)
        items[:] = [item for item in items if not item.get_closest_marker("every")]
    items.sort(key=_slow_first)


def pytest_collection_finish():
    """What all tests share stays to the end: no later collection of garbage looks at it again."""
    gc.collect()
    gc.freeze()


def _slow_first(item):
    place = item.path.relative_to(TESTS).as_posix()
    return next((rank for rank, slow in enumerate(SLOW) if place.startswith(slow)), len(SLOW))


def pytest_terminal_summary(terminalreporter):
    """A line for each ``record_property("measured", text)`` of a test that passed."""
    lines = sorted(text for report in terminalreporter.stats.get("passed", [])
                   for name, text in report.user_properties if name == MEASURED)
    if lines:
        terminalreporter.section(MEASURED)
        for line in lines:
            terminalreporter.line(line)
