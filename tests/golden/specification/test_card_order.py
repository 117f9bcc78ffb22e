"""Card orders as people write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cardcage.golden.specification.card_order import (
    MAXIMUM_CARDS,
    check_cards,
    check_merging,
    domains,
    merge_card,
    node_cards,
    parse_cards,
)
from cardcage.golden.specification.errors import InputError


@pytest.mark.parametrize(("text", "cards"), [
    ("PM", "PM"),
    ("pmm", "PMM"),
    (" P MM\tP MM\n", "PMMPMM"),
    ("4x(PMM)", "PMMPMMPMMPMM"),
    ("2X(PM)", "PMPM"),
    ("2*(PM)", "PMPM"),
    ("2×(PM)", "PMPM"),
    ("P 3xM", "PMMM"),
    ("2x(P 2xM) PM", "PMMPMMPM"),
    ("2x(P2x(MM))", "PMMMMPMMMM"),
    ("(PM)(PM)", "PMPM"),
    ("(PM)", "PM"),
    ("1x(PM)", "PM"),
    ("10xP", "P" * 10),
    ("2x(PMMc)", "PMMCPMMC"),
    ("2x(2x(PM) T)", "PMPMTPMPMT"),
    ("", ""),
])
def test_spelled_out(text, cards):
    assert parse_cards(text) == cards


@pytest.mark.parametrize(("text", "message"), [
    ("PXM", "no card|match|count"),
    ("PAM", "'A' at position 2"),
    ("P-M", "'-' at position 2"),
    ("0x(PM)", "0x"),
    ("5000x(PM)", "5000x"),
    ("4097xM", "4097x"),
    ("2x(2000x(PM))", "cards"),
    ("2x2xM", "two counts"),
    ("2x", "match"),
    ("2(PM)", "a number without an x"),
    ("(PM", "match"),
    ("PM)", "match"),
    (")PM(", "match"),
    ("x(PM)", "an x without a number"),
    ("2P", "a number without an x"),
])
def test_what_cannot_be_read(text, message):
    with pytest.raises(InputError, match=message) as raised:
        parse_cards(text)
    assert str(raised.value).startswith("cards: ")
    assert "\n" not in str(raised.value)


def test_as_many_cards_as_allowed():
    assert len(parse_cards(f"{MAXIMUM_CARDS // 2}x(PM)")) == MAXIMUM_CARDS
    with pytest.raises(InputError, match=str(MAXIMUM_CARDS)):
        parse_cards(f"{MAXIMUM_CARDS // 2}x(PM) M")


ORDER = st.recursive(
    st.sampled_from(["P", "M"]).map(lambda card: (card, card)),
    lambda inner: st.one_of(
        st.lists(inner, min_size=1, max_size=3).map(
            lambda parts: (" ".join(text for text, _ in parts),
                           "".join(cards for _, cards in parts))),
        st.tuples(st.integers(1, 4), inner).map(
            lambda pair: (f"{pair[0]}x({pair[1][0]})", pair[1][1] * pair[0]))),
    max_leaves=6)


@given(ORDER)
def test_groups_in_groups(order):
    text, cards = order
    assert parse_cards(text) == cards
    assert parse_cards(cards) == cards


@pytest.mark.parametrize("cards", ["PM", "PMMP", "PPM", "PMPMMM", "P" + "M" * 16,
                                   "PMC", "PMMTPMMT", "PMMPMMCPMMMMC", "PMMSPMMSF", "PMMPMMSFFFF",
                                   "PDM", "PPPDMMMM"])
def test_machines(cards):
    check_merging(cards)
    check_cards(cards)


@pytest.mark.parametrize(("cards", "merge", "nodes"), [
    ("PMM", None, ["PMM"]), ("PMC", "C", ["PM"]), ("PMMPMMCPMC", "C", ["PMMPMM", "PM"]),
    ("PMTPMT", "T", ["PM", "PM"]), ("PMCC", "C", ["PM", ""]),
    ("PMMSPMSFF", "S", ["PMM", "PM"]), ("PPPDMM", "D", ["P", "P", "P"])])
def test_merge_cards_end_nodes(cards, merge, nodes):
    assert merge_card(cards) == merge
    assert node_cards(cards) == nodes


@pytest.mark.parametrize(("cards", "message"), [
    ("PMCPMT", r"C \(chain merge\) and T \(tree merge\) in one cage; take merge .* of one kind"),
    ("PMTPMC", r"C \(chain merge\) and T \(tree merge\) in one cage; take merge .* of one kind"),
    ("PMSDF", r"S \(snoop .*\) and D \(direct merge\) in one cage; take merge .* of one kind"),
    ("PMCPM", r"the last node is not ended; put C \(chain merge\) at its right end"),
    ("PMTP", r"the last node is not ended; put T \(tree merge\) at its right end"),
    ("PMSPMFF", r"the last node is not ended; put S \(snoop merge\) at its right end"),
    ("PMSPMS", r"no F \(frame unit\) at the right end, which nodes send .*; add some, as in .*FF"),
    ("PMSFPMSF", r"F \(frame unit\) left of a node; put all of them at the right end, as in .*"),
    ("PMF", r"F \(frame unit\) is for nodes that end in S \(snoop merge\); end all nodes so, .*"),
    ("PMCF", r"F \(frame unit\) is for nodes that end in S \(snoop merge\); end all nodes so, .*"),
    ("PMDM", r"memory units on the left of D \(direct merge\), .*; put all of them there, .*"),
    ("PDMP", r"processing elements on the right of D \(direct merge\), .*; put all .*"),
    ("DM", r"no processing element on the left of D \(direct merge\); add some, as in PPPPDMMMM"),
    ("PD", r"no memory unit on the right of D \(direct merge\); add some, as in PPPPDMMMM"),
    ("PDDM", r"2 of D \(direct merge\); take one, as in PPPPDMMMM"),
])
def test_merge_cards_that_are_refused(cards, message):
    with pytest.raises(InputError, match=f"^cards: '{cards}': {message}$") as raised:
        check_merging(cards)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(("cards", "message"), [
    ("PMCPMMC", "^cards: nodes of 1 and 2 memory units in one cage; give all nodes as many$"),
    ("PMMTPMTPMT", "^cards: nodes of 1 and 2 memory units in one cage; give all nodes as many$"),
    ("CPMC", "^cards: node 0, '', has no processing element; add a P to the left$"),
    ("PMCMC", "^cards: node 1, 'M', has no processing element; add a P to the left$"),
    ("PMMCMPMC", r"^cards: node 1, 'MPM', has 1 memory unit\(s\) left of the first"),
    ("PMCPC", "^cards: node 1, 'P', has no memory unit; add an M to the right of a P$"),
    ("2x(PMMMC)", "^cards: 3 memory units are not supported yet; .* such as 2 or 4$"),
    ("2x(PMS)FFF", "^cards: 3 frame units are not supported yet; .* such as 2 or 4$"),
    ("PPDMMM", "^cards: 3 memory units are not supported yet; .* such as 2 or 4$"),
])
def test_nodes_that_are_no_machines(cards, message):
    with pytest.raises(InputError, match=message) as raised:
        check_cards(parse_cards(cards))
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(("cards", "message"), [
    ("", "no processing element"),
    ("MM", "no processing element"),
    ("P", "no memory unit"),
    ("PP", "no memory unit"),
    ("MMPMM", "2 memory unit"),
    ("PMMM", "3 memory units are not supported.* 2 or 4"),
    ("PMMMMPMM", "6 memory units .* 4 or 8"),
])
def test_what_is_no_machine(cards, message):
    with pytest.raises(InputError, match=message):
        check_cards(cards)


@pytest.mark.parametrize(("text", "message"), [
    ("4x(PMMX)", "an x without a number before it; it counts, as in 4x(PMM)"),
    ("x(PM)", "an x without a number before it; it counts, as in 4x(PMM)"),
    ("4PMM", "a number without an x after it; write a count as in 4x(PMM)"),
    ("PM4", "a number without an x after it; write a count as in 4x(PMM)"),
])
def test_counts_that_are_not_written_as_such(text, message):
    with pytest.raises(InputError) as raised:
        parse_cards(text)
    assert str(raised.value) == f"cards: {text!r}: {message}"


@pytest.mark.parametrize(("cards", "expected"), [
    ("PM", [(0, 1)]),
    ("PMMPM", [(0, 2), (2, 1)]),
    ("MMPM", [(2, 1)]),
    ("PPMP", [(0, 0), (0, 1), (1, 0)]),
])
def test_domains(cards, expected):
    assert domains(cards) == expected


@given(st.text("PM", min_size=1, max_size=20))
def test_domains_follow_the_lines(cards):
    """Walk the backplane: each memory unit belongs to the last element passed."""
    shares = [[cards[:slot].count("M"), 0] for slot, card in enumerate(cards) if card == "P"]
    for slot, card in enumerate(cards):
        elements = cards[:slot].count("P")
        if card == "M" and elements:
            shares[elements - 1][1] += 1
    assert domains(cards) == [tuple(share) for share in shares]
