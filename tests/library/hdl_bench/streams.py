"""Both ends of a stream, with pauses, and its protocol checked."""

import random

from amaranth.hdl import Value

from .bench import Agent


def no_pause():
    """Zero waits."""
    return 0


def pauses(seed):
    """Clocks to wait before the next transfer, at random: mostly none, now and then many."""
    source = random.Random(f"pauses {seed}")
    return lambda: source.choice((0, 0, 0, 1, 2, source.randrange(12)))


def once(clocks, pause):
    """``pause`` after waiting ``clocks`` at first."""
    waits = iter([clocks])
    return lambda: next(waits, None) or pause()


class Source(Agent):
    """Sends ``items`` on ``stream``: valid and payload hold until taken.

    ``taken`` lists the clock in which each item was taken.  With ``zero`` the payload
    is 0 while not valid.
    """

    def __init__(self, stream, items, pause=no_pause, *, zero=False):
        self._zero = zero
        self._stream = stream
        self._items = list(items)
        self._pause = pause
        self._wait = pause()
        self._offering = False
        self._clock = 0
        self.taken = []

    @property
    def finished(self):
        return len(self.taken) == len(self._items)

    def drive(self, ctx):
        if self._offering:
            return
        if self._wait or self.finished:
            self._wait = max(0, self._wait - 1)
            ctx.set(self._stream.valid, 0)
            if self._zero:
                ctx.set(Value.cast(self._stream.payload), 0)
            return
        item = self._items[len(self.taken)]
        payload = self._stream.payload
        ctx.set(Value.cast(payload) if isinstance(item, int) else payload, item)
        ctx.set(self._stream.valid, 1)
        self._offering = True

    def sample(self, ctx):
        if self._offering and ctx.get(self._stream.ready):
            self.taken.append(self._clock)
            self._offering = False
            self._wait = self._pause()
        self._clock += 1


class Sink(Agent):
    """Takes what comes on ``stream`` into ``items``, and ``clocks`` when each came.

    Finished with the ``expected`` number of items; more than that are taken,
    too, so a test sees them.  Checks the protocol in every clock: what is
    offered is held until taken, and is offered whatever ready is; with ``zero``,
    that the payload is 0 while not valid.
    """

    def __init__(self, stream, expected=0, pause=no_pause, *, zero=False):
        self._zero = zero
        self._stream = stream
        self._expected = expected
        self._pause = pause
        self._wait = pause()
        self._held = None
        self._clock = 0
        self.items = []
        self.clocks = []

    @property
    def finished(self):
        return len(self.items) >= self._expected

    def drive(self, ctx):
        ctx.set(self._stream.ready, self._wait == 0)

    def _offer(self, ctx):
        if not ctx.get(self._stream.valid):
            assert not self._zero or ctx.get(Value.cast(self._stream.payload)) == 0
            return None
        return ctx.get(Value.cast(self._stream.payload))

    def sample(self, ctx):
        offer = self._offer(ctx)
        ready = self._wait == 0
        ctx.set(self._stream.ready, not ready)
        assert self._offer(ctx) == offer, f"clock {self._clock}: the offer depends on ready"
        ctx.set(self._stream.ready, ready)
        if self._held is not None:
            assert offer == self._held, (
                f"clock {self._clock}: offered {self._held:#x}, then {offer} before it was taken")
        self._held = offer if not ready else None
        if ready and offer is not None:
            self.items.append(ctx.get(self._stream.payload))
            self.clocks.append(self._clock)
            self._wait = self._pause()
        elif self._wait:
            self._wait -= 1
        self._clock += 1
