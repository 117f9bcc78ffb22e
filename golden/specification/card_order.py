"""The order of the boards in the cage, as people write it: ``4x(PMM)``."""

from __future__ import annotations

import re
from itertools import accumulate

from .errors import InputError

PROCESSING_ELEMENT = "P"
MEMORY_UNIT = "M"
#: Every card that a slot can hold, by its letter.  X is no letter: it counts, as in ``4x(PMM)``.
CARD_NAMES = {PROCESSING_ELEMENT: "processing element", MEMORY_UNIT: "memory unit"}
MAXIMUM_CARDS = 4096

_LETTERS = "".join(CARD_NAMES)
_REPEATED = re.compile(rf"(?:(\d+)[Xx*×])?(?:\(([{_LETTERS}]*)\)|([{_LETTERS}]))")


def parse_cards(text: str) -> str:
    """Spell out a card order: ``"2x(PMM) PM"`` → ``"PMMPMMPM"``, left to right.

    Letters of ``CARD_NAMES``, blanks, groups in parentheses, and ``Nx`` before a card or a group.
    Raises ``InputError`` for anything else; whether the machine can be built is ``check_cards``'s
    question.
    """

    def expand(match: re.Match[str]) -> str:
        count = int(match[1] or 1)
        group = match[2] if match[3] is None else match[3]
        if count < 1 or count * len(group) > MAXIMUM_CARDS:
            raise InputError(f"cards: {text!r}: {match[0]!r} is not from 1 to {MAXIMUM_CARDS} "
                             "cards; change the count")
        return group * count

    unknown = re.search(rf"[^{_LETTERS}{_LETTERS.lower()}()\dXx*×\s]", text)
    if unknown:
        known = ", ".join(f"{letter} ({name})" for letter, name in CARD_NAMES.items())
        raise InputError(f"cards: {text!r}: {unknown[0]!r} at position {unknown.start() + 1} is no "
                         f"card; use {known}, blanks and groups such as 2x(PMM)")
    cards, spelled = "".join(text.upper().split()), ""
    if re.search(r"[X*×]\d", cards):
        raise InputError(f"cards: {text!r}: two counts in a row; write one before a card or group")
    while cards != spelled:  # each pass opens the innermost groups
        spelled, cards = cards, _REPEATED.sub(expand, cards)
    if set(cards) - set(_LETTERS):
        raise InputError(f"cards: {text!r}: parentheses and counts do not match; write groups as "
                         "in 4x(PMM)")
    if len(cards) > MAXIMUM_CARDS:
        raise InputError(f"cards: {text!r}: {len(cards)} cards, at most {MAXIMUM_CARDS}")
    return cards


def check_cards(cards: str) -> None:
    """Raise ``InputError`` unless every memory unit has a processing element to its left
    and the number of units is a power of two."""
    if PROCESSING_ELEMENT not in cards:
        raise InputError(f"cards: {cards!r} has no processing element; add a P to the left")
    if MEMORY_UNIT not in cards:
        raise InputError(f"cards: {cards!r} has no memory unit; add an M to the right of a P")
    if cards[0] == MEMORY_UNIT:
        left = len(cards) - len(cards.lstrip(MEMORY_UNIT))
        raise InputError(f"cards: {cards!r}: {left} memory unit(s) left of the first processing "
                         "element belong to nobody; start with a P")
    units = cards.count(MEMORY_UNIT)
    if units & (units - 1):
        lower = 1 << (units.bit_length() - 1)
        raise InputError(f"cards: {units} memory units are not supported yet; the number must be a "
                         f"power of two, such as {lower} or {2 * lower}")


def domains(cards: str) -> list[tuple[int, int]]:
    """(first unit, number of units) owned by each processing element, left to right."""
    shares = [part.count(MEMORY_UNIT) for part in cards.split(PROCESSING_ELEMENT)]
    firsts = list(accumulate(shares))
    return list(zip(firsts[:-1], shares[1:], strict=True))
