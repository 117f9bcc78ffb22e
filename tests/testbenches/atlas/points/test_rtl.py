"""Points in RTL: pictures compared, one node of a large cage with what comes in at its ports."""

from dataclasses import replace

import pytest
from atlas_sweeps import SMALL

from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.atlas.atlas import AtlasOptions
from cardcage.testbenches.atlas.points.atlas_point import Failure
from cardcage.testbenches.atlas.points.measure import batches, measure
from cardcage.testbenches.atlas.points.node_check import CheckedNode
from cardcage.testbenches.comparison.cage import CageJob
from cardcage.testbenches.support.measurement_cache import package_hash

SIMULATED = replace(SMALL, scenes=("tetra:depth=0",), sizes=((8, 8),), cages=("2x(PMT)",),
                    simulate=True, engine="pysim")
#: Of four nodes the busiest one of a chain has pixels from its left; of a tree's only the third
#: receives once.
CHECKED = replace(SMALL, scenes=("random:n=40,size=8,seed=3",), sizes=((16, 16),), retain=True,
                  check_node=True, engine="pysim", cages=("4x(PMC)", "4x(PMT)"))


def measured(options):
    return [outcome for batch in batches(options.points(), package_hash())
            for outcome in measure(batch)]


@pytest.fixture(scope="module")
def simulated():
    """What the cage did, and what was found."""
    runs = []
    whole = CageJob.run

    def recording(job):
        runs.append(whole(job))
        return runs[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CageJob, "run", recording)
        return runs, measured(SIMULATED)


def test_a_simulated_point_has_its_own_clocks_beside_the_models(simulated):
    [figures] = simulated[1]
    assert figures["source"] == "rtl"
    found = figures["simulated"]
    assert found["pixels_compared"] == found["depths_compared"] == 64
    assert found["fragments"] == figures["fragments"] == 38
    assert figures["merge"] == found["model"]["merge"]
    assert abs(figures["draw"] - found["model"]["draw"]) <= 4


def test_a_wrong_picture_is_a_failure(monkeypatch, simulated):
    def wrong(job):
        return replace(simulated[0][0], differences=["1 of 64 colours differ"])

    monkeypatch.setattr(CageJob, "run", wrong)
    [failure] = measured(SIMULATED)
    assert failure == Failure("1 of 64 colours differ", failed=True)


@pytest.fixture(scope="module")
def recorded():
    """What both nodes' machines answered, and what was found."""
    simulations = []
    whole = CheckedNode._simulated

    def recording(node, stand_in):
        simulations.append(whole(node, stand_in))
        return simulations[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CheckedNode, "_simulated", recording)
        return simulations, [figures["node_check"] for figures in measured(CHECKED)]


@pytest.fixture
def checks(recorded):
    return recorded[1]


def test_one_node_of_a_chain_and_of_a_tree(checks, record_property):
    chain, tree = checks
    assert 0 < chain["node"] < 4 and tree["node"] == 2
    assert "merge" not in chain
    for check in checks:
        assert (check["nodes"], check["elements"], check["of_node"]) == (4, 4, 1)
        assert check["pixels_compared"] == 256
        assert check["fragments"]["model"] == check["fragments"]["rtl"] > 30
        clocks = check["clocks"]
        assert abs(clocks["rtl"] - clocks["model"]) <= 8 + 0.05 * clocks["model"]
        record_property("measured", f"node {check['node']} of 4 in RTL: {clocks['rtl']} clocks, by "
                        f"the model {clocks['model']}")
    assert tree["pixels_in"]["model"] == tree["pixels_in"]["rtl"] < 256
    assert abs(tree["merge"]["rtl"] - tree["merge"]["model"]) <= 2


@pytest.mark.parametrize("what", ["video", "depth", "fragments"])
def test_a_node_that_errs_is_found(monkeypatch, recorded, what):
    simulation = recorded[0][1]

    def wrong(node, stand_in):
        if what == "fragments":
            first, *others = simulation.work
            return replace(simulation, work=[replace(first, fragments=first.fragments + 1),
                                             *others])
        changed = getattr(simulation, what).copy()
        changed[3, 4] ^= 1
        return replace(simulation, **{what: changed})

    monkeypatch.setattr(CheckedNode, "_simulated", wrong)
    [failure] = measured(replace(CHECKED, cages=CHECKED.cages[1:]))
    assert isinstance(failure, Failure) and failure.failed
    assert failure.reason.startswith("node 2: ")


def test_the_pixels_that_come_in_are_those_of_all_nodes_left_of_it():
    """The other node of the two draws what is seen of them, and no more."""
    point = CHECKED.points()[0]
    node = CheckedNode(point.machine(), point.scene.load().display_list, "pysim")
    assert 0 < len(node.seen) < len(node.listed.position)
    assert all(triangle < node._own(node.node).min() for triangle in node.seen)


def test_what_cannot_be_checked_is_refused():
    for options in ({"retain": False}, {"cages": ("4x(PMS)F",)}, {"cages": ("3x(PMC)",)},
                    {"fraction_bits": (2,)}):
        with pytest.raises(InputError, match="--check-node: there is no chain or tree"):
            replace(CHECKED, **options).points()
    with pytest.raises(InputError, match="--nodes: 65"):
        AtlasOptions(nodes=(65,))
