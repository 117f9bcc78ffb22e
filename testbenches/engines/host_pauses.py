"""When the host pauses."""

from __future__ import annotations

import random


class Pace:
    """One handshake signal of the host: held high, or low for a random while before.

    ``seed`` None never pauses.  One seed gives every Python host the same pauses, so that their
    runs can be compared clock by clock; ``salt`` tells the handshakes of one host apart.
    """

    def __init__(self, seed: int | None, salt: int) -> None:
        self._source = None if seed is None else random.Random(seed * 2 + salt)
        self._pause = 0
        self.high = False

    def go(self) -> None:
        """Offer the next transfer, after a pause: mostly none, now and then a long one."""
        if self._source is not None:
            self._pause = self._source.choice((0, 0, 0, 1, 2, self._source.randrange(20)))
        self.high = self._pause == 0

    def wait(self) -> None:
        """A clock without a transfer."""
        if self._pause:
            self._pause -= 1
            self.high = self._pause == 0

    def stop(self) -> None:
        self._pause = 0
        self.high = False
