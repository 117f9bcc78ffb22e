"""Makes ``library/`` importable: the test modules share the drivers and models in ``hdl_bench``."""

import sys
from pathlib import Path

import pytest

LIBRARY = str(Path(__file__).parent / "library")
if LIBRARY not in sys.path:
    sys.path.insert(0, LIBRARY)
pytest.register_assert_rewrite("hdl_bench")
