"""Checks the three signals of a stream against its rules."""

from __future__ import annotations

from .violation import ProtocolError


class StreamCheck:
    """Call ``sample`` with what each clock edge sees; None stands for an unknown level (X or Z).

    Raises ``ProtocolError`` where the side that offers takes an offer back or changes it
    before it is taken, or where ``valid``, ``ready`` or an offered payload is unknown.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._waiting: int | None = None

    def sample(self, cycle: int, valid: int | None, ready: int | None,
               payload: int | None) -> bool:
        """Whether the payload passes at this edge."""
        if valid is None or ready is None:
            self._fail(cycle, f"{'valid' if valid is None else 'ready'} is unknown")
        if not valid:
            if self._waiting is not None:
                self._fail(cycle, f"valid fell before {self._waiting:#x} was taken")
            return False
        if payload is None:
            self._fail(cycle, "the payload is unknown while valid is high")
        if self._waiting is not None and payload != self._waiting:
            self._fail(cycle, f"the payload changed from {self._waiting:#x} to {payload:#x} "
                              "before it was taken")
        self._waiting = None if ready else payload
        return bool(ready)

    def _fail(self, cycle: int, what: str) -> None:
        raise ProtocolError(f"cycle {cycle}: {self._name}: {what}")
