"""The order of the boards in the cage, as people write it: ``4x(PMM)``."""

from __future__ import annotations

import re
from itertools import accumulate

from .errors import InputError

PROCESSING_ELEMENT = "P"
MEMORY_UNIT = "M"
CHAIN_MERGE = "C"
TREE_MERGE = "T"
#: Every card that a slot can hold, by its letter.  X is no letter: it counts, as in ``4x(PMM)``.
CARD_NAMES = {PROCESSING_ELEMENT: "processing element", MEMORY_UNIT: "memory unit",
              CHAIN_MERGE: "chain merge", TREE_MERGE: "tree merge"}
#: The Verilog module of each.
CARD_MODULES = {letter: name.replace(" ", "_") for letter, name in CARD_NAMES.items()}
#: Cards that end a node, which keeps a picture of its own, and merge its picture with the others'.
MERGE_CARDS = (CHAIN_MERGE, TREE_MERGE)
MAXIMUM_CARDS = 4096
MAXIMUM_NODES = 64

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


def merge_card(cards: str) -> str | None:
    """The kind of card that ends the nodes of a cage; None where it is all one node."""
    return next((card for card in cards if card in MERGE_CARDS), None)


def node_cards(cards: str) -> list[str]:
    """The cards of each node, without the merge card that ends it.

    >>> node_cards("PMMPMMCPMC")
    ['PMMPMM', 'PM']
    """
    merge = merge_card(cards)
    return [cards] if merge is None else cards.split(merge)[:-1]


def check_nodes(cards: str) -> None:
    """Raise ``InputError`` unless all merge cards are of one kind, the last card is one, and they
    are not too many."""
    merge = merge_card(cards)
    if merge is None:
        return
    kinds = [f"{card} ({CARD_NAMES[card]})" for card in MERGE_CARDS if card in cards]
    if len(kinds) > 1:
        raise InputError(f"cards: {cards!r}: {' and '.join(kinds)} in one cage; end all nodes with "
                         "merge cards of one kind")
    if cards[-1] != merge:
        raise InputError(f"cards: {cards!r}: the last node is not ended; add a {merge} "
                         f"({CARD_NAMES[merge]}) at the right end")
    nodes = cards.count(merge)
    if nodes > MAXIMUM_NODES:
        raise InputError(f"cards: {nodes} nodes, at most {MAXIMUM_NODES}; end fewer of them, with "
                         "more processing elements in each")


def check_cards(cards: str) -> None:
    """Raise ``InputError`` unless in every node each memory unit has a processing element to its
    left, and all nodes have one number of units, a power of two."""
    nodes = node_cards(cards)
    for number, node in enumerate(nodes):
        _check_node(node, repr(node) if node == cards else f"node {number}, {node!r},")
    units = sorted({node.count(MEMORY_UNIT) for node in nodes})
    if len(units) > 1:
        raise InputError(f"cards: nodes of {' and '.join(map(str, units))} memory units in one "
                         "cage; give all nodes as many")


def _check_node(cards: str, called: str) -> None:
    """``check_cards`` of one node, which messages call so."""
    if PROCESSING_ELEMENT not in cards:
        raise InputError(f"cards: {called} has no processing element; add a P to the left")
    if MEMORY_UNIT not in cards:
        raise InputError(f"cards: {called} has no memory unit; add an M to the right of a P")
    if cards[0] == MEMORY_UNIT:
        left = len(cards) - len(cards.lstrip(MEMORY_UNIT))
        raise InputError(f"cards: {called} has {left} memory unit(s) left of the first processing "
                         "element, which belong to nobody; start with a P")
    units = cards.count(MEMORY_UNIT)
    if units & (units - 1):
        lower = 1 << (units.bit_length() - 1)
        raise InputError(f"cards: {units} memory units are not supported yet; the number must be a "
                         f"power of two, such as {lower} or {2 * lower}")


def domains(cards: str) -> list[tuple[int, int]]:
    """(first unit, number of units) owned by each processing element of a node, left to right."""
    shares = [part.count(MEMORY_UNIT) for part in cards.split(PROCESSING_ELEMENT)]
    firsts = list(accumulate(shares))
    return list(zip(firsts[:-1], shares[1:], strict=True))
