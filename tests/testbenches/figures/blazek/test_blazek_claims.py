"""Claims on methods whose speed-ups are chosen so that they come out, or do not."""

from dataclasses import dataclass, field

from cardcage.testbenches.figures.blazek import claims
from cardcage.testbenches.figures.blazek.claims import Methods, claims_of, claims_of_all, summary
from cardcage.testbenches.figures.blazek.page import SECTIONS
from cardcage.testbenches.figures.blazek.scenes.speed_ups import SpeedUps
from cardcage.testbenches.figures.blazek.scenes.spheres import SPHERES
from cardcage.testbenches.figures.blazek.slips import slips


@dataclass
class Chosen(SpeedUps):
    """``exponent``: a speed-up of n ** exponent."""

    exponent: float
    name: str = ""
    slower: float = 1.0
    merged: float = 0.0
    growth: float = 0.0
    points: dict = field(default_factory=dict)

    def time(self, spheres, nodes):
        exponent = self.exponent + self.growth * SPHERES.index(spheres)
        return self.slower * spheres / nodes ** exponent

    def merging(self, spheres, nodes):
        return self.merged * self.time(spheres, nodes)


def methods(**changes):
    usual = {"host initiated, 10": Chosen(-0.1, slower=1.05), "host initiated, 100": Chosen(-0.1),
             "node initiated": Chosen(0.9), "forwarding, strips": Chosen(0.6),
             "broadcast, lines": Chosen(0.85), "broadcast, strips": Chosen(0.7)}
    return Methods(usual | {name.replace("_", " ").replace("  ", ", "): method
                            for name, method in changes.items()})


def outcomes(found, spheres=64):
    return {verdict.claim: verdict.came_out for verdict in claims_of(found, spheres)}


def test_as_in_the_thesis():
    assert all(outcomes(methods()).values())
    numbers = {verdict.claim: verdict.numbers for verdict in claims_of(methods(), 64)}
    assert numbers[claims.PACKET] == "on 32 nodes the worst packet takes 5 % longer than the best"
    assert numbers[claims.GOOD] == "on 32 nodes a speed-up of 19.0, 0.84 of node initiated"
    assert all(each.scenes == len(SPHERES) for each in summary(methods())[:-2])


def test_otherwise():
    assert not outcomes(methods(host_initiated__100=Chosen(0.7)))[claims.POOR]
    assert not outcomes(methods(host_initiated__100=Chosen(0.3)))[claims.FALLS]
    assert not outcomes(methods(host_initiated__10=Chosen(-0.1, slower=1.2)))[claims.PACKET]
    best = methods(forwarding__strips=Chosen(0.95))
    assert not outcomes(best)[claims.BEST] and not outcomes(best)[claims.WELL_BELOW]
    assert not outcomes(methods(node_initiated=Chosen(0.9, merged=0.2)))[claims.MERGED]
    assert not outcomes(methods(forwarding__strips=Chosen(1.1)))[claims.NARROW]
    assert not outcomes(methods(broadcast__strips=Chosen(0.9)))[claims.LINES]


def test_nearly_as_good_is_good_as_well():
    assert not outcomes(methods(broadcast__lines=Chosen(0.5)))[claims.GOOD]
    both = methods(broadcast__lines=Chosen(0.5), node_initiated=Chosen(0.52))
    assert not outcomes(both)[claims.GOOD]
    assert not outcomes(methods(broadcast__lines=Chosen(0.95)))[claims.GOOD]


def test_more_spheres():
    worse, better = claims_of_all(methods(host_initiated__100=Chosen(0.1, growth=-0.02),
                                          node_initiated=Chosen(0.5, growth=0.04)))
    assert worse.claim == claims.POORER and worse.came_out and better.came_out
    same, falls = claims_of_all(methods(node_initiated=Chosen(0.9, growth=-0.01)))
    assert not same.came_out and not falls.came_out


def test_every_claim_is_on_the_page():
    shown = {claim for section in SECTIONS for claim in section.claims}
    assert {each.claim for each in summary(methods())} <= shown


def test_slips():
    said = {slip.printed.split(" ")[0]: slip for slip in slips()}
    assert "2.9 hours" in said["messages"].why and "12 seconds" in said["messages"].why
    assert "2,048 or 8,192" in said["each"].why and "10.4 million" in said["in"].why
