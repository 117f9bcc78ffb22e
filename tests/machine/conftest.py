"""Makes ``library/`` importable: the test modules share the frame check in ``frames``."""

import sys
from pathlib import Path

import pytest

LIBRARY = str(Path(__file__).parent / "library")
if LIBRARY not in sys.path:
    sys.path.insert(0, LIBRARY)
pytest.register_assert_rewrite("frames")
