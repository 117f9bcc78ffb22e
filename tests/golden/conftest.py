"""Makes ``library/`` importable: what several test modules share."""

import sys
from pathlib import Path

LIBRARY = str(Path(__file__).parent / "library")
if LIBRARY not in sys.path:
    sys.path.insert(0, LIBRARY)
