"""How long the hardware balancer takes to make a table."""


def balancer_clocks(regions: int, elements: int, slots: int) -> int:
    """Clocks from the first count to the end, both included, where no count is waited for.

    In turn: a count of each slot; the count of each region; passes of a merge sort, two clocks an
    item and two a pair, but for the last pass, whose items are packed as they come; and each
    region but the first, which everybody is free for, a look at every processing element.
    """
    passes = max(1, (regions - 1).bit_length())
    sorting = sum(2 * regions + 2 * -(-regions // (2 << number)) for number in range(passes - 1))
    return elements * slots + regions + sorting + (regions - 1) * (elements + 2) + 7
