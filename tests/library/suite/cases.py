"""Which cases a run of the tests takes: some that stand for all, or with ``--every`` every one."""

import pytest

#: Of a case, or of a test, that only ``pytest --every`` runs.
EVERY = pytest.mark.every


def chosen(cases, *names):
    """Parameters for all ``cases``, in their order: those named are run each time, the others only
    with ``--every``.  A tuple is a case of one parameter.  Raises ``ValueError`` where a name is no
    case."""
    if unknown := [name for name in names if name not in cases]:
        raise ValueError(f"no such case: {', '.join(map(str, unknown))}")
    return [pytest.param(case, marks=[EVERY] * (case not in names)) for case in cases]
