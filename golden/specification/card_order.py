"""The order of the boards in the cage, as people write it: ``4x(PMM)``."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import accumulate

from .errors import InputError

PROCESSING_ELEMENT = "P"
MEMORY_UNIT = "M"
CHAIN_MERGE = "C"
TREE_MERGE = "T"
SNOOP_MERGE = "S"
FRAME_UNIT = "F"
DIRECT_MERGE = "D"
#: Every card that a slot can hold, by its letter.  X is no letter: it counts, as in ``4x(PMM)``.
CARD_NAMES = {PROCESSING_ELEMENT: "processing element", MEMORY_UNIT: "memory unit",
              CHAIN_MERGE: "chain merge", TREE_MERGE: "tree merge", SNOOP_MERGE: "snoop merge",
              FRAME_UNIT: "frame unit", DIRECT_MERGE: "direct merge"}
#: The Verilog module of each.
CARD_MODULES = {letter: name.replace(" ", "_") for letter, name in CARD_NAMES.items()}
#: Cards that end a node, which keeps a picture of its own.
NODE_ENDS = (CHAIN_MERGE, TREE_MERGE, SNOOP_MERGE)
#: Cards that make one picture of what nodes draw.
MERGE_CARDS = (*NODE_ENDS, DIRECT_MERGE)
#: Cards that only cages with some kind of merge card have.
MERGING_CARDS = (*MERGE_CARDS, FRAME_UNIT)
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
    if re.search(r"(?<!\d)X", cards):
        raise InputError(f"cards: {text!r}: an x without a number before it; it counts, as in "
                         "4x(PMM)")
    if re.search(r"\d(?![\dX*×])", cards):
        raise InputError(f"cards: {text!r}: a number without an x after it; write a count as in "
                         "4x(PMM)")
    if set(cards) - set(_LETTERS):
        raise InputError(f"cards: {text!r}: parentheses and counts do not match; write groups as "
                         "in 4x(PMM)")
    if len(cards) > MAXIMUM_CARDS:
        raise InputError(f"cards: {text!r}: {len(cards)} cards, at most {MAXIMUM_CARDS}")
    return cards


def merge_card(cards: str) -> str | None:
    """The kind of card by which a cage merges what its nodes draw; None where it is all one
    node."""
    return next((card for card in cards if card in MERGE_CARDS), None)


def node_cards(cards: str) -> list[str]:
    """The cards of each node, without the merge card that ends it; before a direct merge each
    processing element is a node.

    >>> node_cards("PMMPMMCPMC")
    ['PMMPMM', 'PM']
    >>> node_cards("PPDMM")
    ['P', 'P']
    """
    merge = merge_card(cards)
    if merge is None:
        return [cards]
    if merge == DIRECT_MERGE:
        return list(cards[:cards.index(DIRECT_MERGE)])
    return cards.split(merge)[:-1]


def check_merging(cards: str) -> None:
    """Raise ``InputError`` unless all merge cards are of one kind, each stands where it can merge,
    and nodes are not too many."""
    merge = merge_card(cards)
    kinds = [_called(card) for card in MERGE_CARDS if card in cards]
    if len(kinds) > 1:
        raise InputError(f"cards: {cards!r}: {' and '.join(kinds)} in one cage; take merge cards "
                         "of one kind")
    if FRAME_UNIT in cards and merge != SNOOP_MERGE:
        raise InputError(f"cards: {cards!r}: {_called(FRAME_UNIT)} is for nodes that end in "
                         f"{_called(SNOOP_MERGE)}; end all nodes so, as in 4x(PMMS)FF")
    if merge == SNOOP_MERGE:
        _check_frame_units(cards)
    if merge == DIRECT_MERGE:
        _check_direct(cards)
    elif merge is not None and cards.rstrip(FRAME_UNIT)[-1] != merge:
        raise InputError(f"cards: {cards!r}: the last node is not ended; put {merge} "
                         f"({CARD_NAMES[merge]}) at its right end")
    nodes = len(node_cards(cards))
    if nodes > MAXIMUM_NODES:
        raise InputError(f"cards: {nodes} nodes, at most {MAXIMUM_NODES}; take fewer" + (
            "" if merge == DIRECT_MERGE else ", with more processing elements in each"))


def _called(card: str) -> str:
    return f"{card} ({CARD_NAMES[card]})"


def _check_frame_units(cards: str) -> None:
    """The frame units are at the right end, after the last node."""
    frame_units = len(cards) - len(cards.rstrip(FRAME_UNIT))
    if FRAME_UNIT not in cards:
        raise InputError(f"cards: {cards!r}: no {_called(FRAME_UNIT)} at the right end, which "
                         "nodes send their pixels to; add some, as in 4x(PMMS)FF")
    if not frame_units or FRAME_UNIT in cards.rstrip(FRAME_UNIT):
        raise InputError(f"cards: {cards!r}: {_called(FRAME_UNIT)} left of a node; put all of them "
                         "at the right end, as in 4x(PMMS)FF")


def _check_direct(cards: str) -> None:
    """Processing elements, one merge card, memory units, in this order."""
    left, _, right = cards.partition(DIRECT_MERGE)
    direct = _called(DIRECT_MERGE)
    if DIRECT_MERGE in right:
        raise InputError(f"cards: {cards!r}: {right.count(DIRECT_MERGE) + 1} of {direct}; take "
                         "one, as in PPPPDMMMM")
    if MEMORY_UNIT in left:
        raise InputError(f"cards: {cards!r}: memory units on the left of {direct}, which reaches "
                         "those on its right only; put all of them there, as in PPPPDMMMM")
    if PROCESSING_ELEMENT in right:
        raise InputError(f"cards: {cards!r}: processing elements on the right of {direct}, which "
                         "hears those on its left only; put all of them there, as in PPPPDMMMM")
    if not left:
        raise InputError(f"cards: {cards!r}: no processing element on the left of {direct}; add "
                         "some, as in PPPPDMMMM")
    if not right:
        raise InputError(f"cards: {cards!r}: no memory unit on the right of {direct}; add some, as "
                         "in PPPPDMMMM")


def check_cards(cards: str, *, dealt: bool = False) -> None:
    """Raise ``InputError`` unless in every node each memory unit has a processing element to its
    left, and all nodes have one number of units; this and the number of frame units are powers of
    two.  ``dealt``: regions are dealt out to processing elements, so that these have powers of two
    of units, and there may be any number of them."""
    if DIRECT_MERGE in cards:
        _check_power_of_two(cards.count(MEMORY_UNIT), CARD_NAMES[MEMORY_UNIT])
        return
    nodes = node_cards(cards)
    for number, node in enumerate(nodes):
        _check_node(node, repr(node) if node == cards else f"node {number}, {node!r},")
        if dealt:
            check_equal_shares(units for _, units in domains(node))
        else:
            _check_power_of_two(node.count(MEMORY_UNIT), CARD_NAMES[MEMORY_UNIT],
                                dealing=node == cards)
    units = sorted({node.count(MEMORY_UNIT) for node in nodes})
    if len(units) > 1:
        raise InputError(f"cards: nodes of {' and '.join(map(str, units))} memory units in one "
                         "cage; give all nodes as many")
    if FRAME_UNIT in cards:
        _check_power_of_two(cards.count(FRAME_UNIT), CARD_NAMES[FRAME_UNIT])


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


def check_equal_shares(shares: Iterable[int]) -> None:
    """Raise ``InputError`` unless all processing elements have one number of memory units, a power
    of two."""
    sizes = sorted(set(shares))
    if len(sizes) > 1 or sizes[0] & (sizes[0] - 1) or not sizes[0]:
        raise InputError("cards: where regions are dealt out all processing elements have as many "
                         f"memory units, a power of two, not {' and '.join(map(str, sizes))}; take "
                         "a cage such as 3x(PMM)")


def _check_power_of_two(units: int, called: str, *, dealing: bool = False) -> None:
    """``dealing``: regions could be dealt out instead."""
    if units & (units - 1):
        lower = 1 << (units.bit_length() - 1)
        raise InputError(f"cards: {units} {called}s are not supported yet; the number must be a "
                         f"power of two, such as {lower} or {2 * lower}"
                         + ("; or deal regions of the screen out to any number of processing "
                            "elements, as with --regions 8x8" if dealing else ""))


def domains(cards: str) -> list[tuple[int, int]]:
    """(first unit, number of units) owned by each processing element of a node, left to right."""
    shares = [part.count(MEMORY_UNIT) for part in cards.split(PROCESSING_ELEMENT)]
    firsts = list(accumulate(shares))
    return list(zip(firsts[:-1], shares[1:], strict=True))


class Cage:
    """What an order of cards says of a machine; whoever has ``cards`` can be asked."""

    cards: str

    @property
    def merge(self) -> str | None:
        """The card by which nodes merge what they draw; None where the cage is all one node."""
        return merge_card(self.cards)

    @property
    def merges_directly(self) -> bool:
        """Processing elements keep no pixels: each fragment goes to the memory unit that has its
        pixel."""
        return self.merge == DIRECT_MERGE

    @property
    def scans_rank(self) -> bool:
        """Pictures are merged as they are scanned, so that the shown one has its depths as well."""
        return self.merge == CHAIN_MERGE

    @property
    def sends_drawn(self) -> bool:
        """Nodes send what they have drawn to one another, and so know it."""
        return self.merge == TREE_MERGE

    @property
    def snoops(self) -> bool:
        """Nodes send what they have drawn to frame units, and hear what the others send."""
        return self.merge == SNOOP_MERGE

    @property
    def keeps_two_depths(self) -> bool:
        """A picture that is finished still has its depths while the next one is drawn."""
        return self.scans_rank or self.snoops

    @property
    def node_cards(self) -> list[str]:
        """The cards of each node, without the merge card."""
        return node_cards(self.cards)

    @property
    def nodes(self) -> int:
        return len(self.node_cards)

    @property
    def units(self) -> int:
        """Memory units of a node; where nodes merge directly, which they share, of the cage."""
        if self.merges_directly:
            return self.cards.count(MEMORY_UNIT)
        return max(node.count(MEMORY_UNIT) for node in self.node_cards)

    @property
    def frame_units(self) -> int:
        return self.cards.count(FRAME_UNIT)

    @property
    def processing_elements(self) -> int:
        return self.cards.count(PROCESSING_ELEMENT)

    @property
    def shares_of_units(self) -> set[int]:
        """How many units processing elements have."""
        if self.merges_directly:
            return {self.units}
        return {units for node in self.node_cards for _, units in domains(node)}
