"""Random numbers that stay the same for a seed on every machine and numpy release."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


class RandomNumbers:
    """Uniform numbers from the raw words of PCG64 (O'Neill 2014).

    numpy promises the words of a bit generator for a seed, but not what its
    distributions make of them; so the two needed here are made on the spot.
    """

    def __init__(self, seed: int) -> None:
        self._words = np.random.PCG64(seed)

    def uniform(self, *shape: int) -> NDArray[np.float64]:
        """float64 of ``shape`` in [0, 1), multiples of 2**-53."""
        return self._raw(shape) * 2.0**-53

    def integers(self, below: int, *shape: int) -> NDArray[np.int64]:
        """int64 of ``shape`` in [0, ``below``), ``below`` at most 2**32."""
        # 53 random bits against at most 32: the bias is below 2**-21.
        return np.floor(self._raw(shape) * 2.0**-53 * below).astype(np.int64)

    def _raw(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        words = np.asarray(self._words.random_raw(int(np.prod(shape))), np.uint64)
        return (words >> np.uint64(11)).astype(np.float64).reshape(shape)
