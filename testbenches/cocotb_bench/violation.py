"""The one exception of all checks."""

from __future__ import annotations


class ProtocolError(AssertionError):
    """The machine did what its documents rule out; the message has the cycle and what."""
