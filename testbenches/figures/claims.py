"""What Cox and Hanrahan observe on their figures (1993, section 7.2), held against ours.

Each claim is asked of each scene that it is about, dealt out round robin as theirs were.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from .paper_table import paper_rows
from .scene_traffic import CONTIGUOUS, NODES, SHUFFLED, SceneTraffic
from .verdict import Summary, Verdict, together

#: As many nodes as there are on the figures: where the plateau is.
MOST = NODES[-1]

#: "Close", "about": within a fifth.
NEAR = 0.2

#: "When depth complexity is high": greater than three.
HIGH_DEPTH = 3

#: What low depth complexity is reduced by: less than a factor of two.
LOW_REDUCTION = 2

#: A plateau: twice the nodes have so much more traffic at most.
FLAT = 0.05


CLOSE = "Expected traffic is close to observed traffic."
REDUCED = "At a depth above three traffic is reduced as the paper's scene of that row was."
EFFECTIVE = "At a depth above three traffic is reduced by a factor of two or more."
LESS_DRAMATIC = "At a low depth traffic is reduced by less than a factor of two."
PATHOLOGIC = "With the background first observed traffic exceeds expected traffic."
RANDOMISED = "Assigning triangles at random brings it below what is expected."
LATER = "A background that the last processor has does not exceed it."
PLATEAU = "Observed traffic grows before it reaches a plateau."
FLAT_EXPECTED = "Expected traffic, which ignores local Z-buffering, is not exceeded on few nodes."


def claims_of(scene: SceneTraffic) -> list[Verdict]:
    """Those that are about the scene, in the paper's order."""
    return [Verdict(claim, scene.name, came_out, numbers)
            for claim, came_out, numbers in _claims(scene)]


def _claims(scene: SceneTraffic) -> Iterator[tuple[str, bool, str]]:
    observed = [scene.observed(nodes) for nodes in NODES]
    last, expected = observed[-1], scene.expected
    of_bound = (f"observed is {last:.2f}, equation 4 says {expected:.2f}, and pixel by pixel "
                f"equation 3 {scene.expected_by_pixel:.2f}")
    if scene.background is None:
        yield CLOSE, abs(last / expected - 1) <= NEAR, of_bound
        yield from _reductions(scene)
    elif scene.background == "first":
        yield PATHOLOGIC, last > expected, of_bound
        shuffled = scene.curve(SHUFFLED)
        mean = scene.observed(MOST, SHUFFLED)
        yield RANDOMISED, mean <= expected, (
            f"{mean:.2f} on average, but from {scene.ratio(shuffled.least[-1]):.2f} to "
            f"{scene.ratio(shuffled.most[-1]):.2f}, as the background's node happens to fall; "
            f"expected {expected:.2f}")
    else:
        contiguous = scene.observed(MOST, CONTIGUOUS)
        yield LATER, contiguous <= expected, (
            f"dealt out contiguously, so that it is sent last, it is {contiguous:.2f}, expected "
            f"{expected:.2f}")
        return
    grown = [later / before - 1 for before, later in pairwise(observed)]
    yield PLATEAU, grown[0] > FLAT >= abs(grown[-1]), (
        f"the first doubling of the nodes adds {round(100 * grown[0])} %, the last one "
        f"{round(100 * grown[-1])} %")
    few = NODES[3]
    yield FLAT_EXPECTED, scene.observed(few) <= expected, (
        f"{scene.observed(few):.2f} on {few} nodes; with local Z-buffering "
        f"{scene.among(few):.2f} would be expected")


def _reductions(scene: SceneTraffic) -> Iterator[tuple[str, bool, str]]:
    found = scene.reduction(MOST)
    row = next((row for row in paper_rows() if row.name == scene.row), None)
    # Random triangles cover the screen as theirs did, of which most of our meshes' is empty.
    depth = scene.drawn_depth if row is None else row.found_depth
    numbers = f"by {found:.1f}, at a depth of {depth:.1f}"
    if row is not None and row.reduction is not None:
        yield REDUCED, abs(found / row.reduction - 1) <= NEAR, (
            f"{numbers}; {row.name} by {row.reduction:.1f}")
    elif depth > HIGH_DEPTH:
        yield EFFECTIVE, found >= LOW_REDUCTION, numbers
    else:
        yield LESS_DRAMATIC, found < LOW_REDUCTION, numbers


def summary(scenes: Sequence[SceneTraffic]) -> list[Summary]:
    """Each claim once, of all scenes together."""
    return together(verdict for scene in scenes for verdict in claims_of(scene))
