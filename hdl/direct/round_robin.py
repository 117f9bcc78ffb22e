"""Who is next, fairly."""

from amaranth.hdl import *
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

__all__ = ["RoundRobin"]


class RoundRobin(wiring.Component):
    """Grants one request at a time: the first one after that which was granted last, in a circle.

    So nobody who keeps asking waits for more than each of the others once.

    Latency: none.  Throughput: a grant a clock.

    Parameters
    ----------
    requesters: int, positive

    Members
    -------
    requests: In(requesters)
        Who asks.
    grant: Out(requesters)
        One of the requests, whatever ``take`` is; 0 where there are none.
    take: In(1)
        The grant counts: the circle goes on from there.

    Raises ``ValueError`` when ``requesters`` is not positive.
    """

    def __init__(self, *, requesters: int):
        if requesters < 1:
            raise ValueError(f"requesters must be positive, not {requesters!r}")
        self.requesters = requesters
        super().__init__({
            "requests": In(requesters),
            "grant": Out(requesters),
            "take": In(1),
        })

    def elaborate(self, platform):
        m = Module()
        requests, grant = self.requests, self.grant
        after = Signal(self.requesters)  # those after the one that was granted last
        ahead = Signal.like(requests)
        m.d.comb += [
            ahead.eq(requests & after),
            grant.eq(Mux(ahead.any(), _lowest(ahead), _lowest(requests))),
        ]
        with m.If(self.take & requests.any()):
            m.d.sync += after.eq(~(grant | (grant - 1)))
        return m


def _lowest(word: Value) -> Value:
    """The lowest bit that is set, alone."""
    return word & -word
