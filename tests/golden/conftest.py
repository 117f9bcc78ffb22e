"""Makes ``library/`` importable: the test modules share how edges are stepped in ``edge_steps``."""

import sys
from pathlib import Path

LIBRARY = str(Path(__file__).parent / "library")
if LIBRARY not in sys.path:
    sys.path.insert(0, LIBRARY)
