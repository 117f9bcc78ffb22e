"""Every hard case through the compiled machine, at exact and at coarser precisions.

One machine for all cases of a size draws them, each from other random memory;
colours are compared as they leave the video output, depths as they are read back.
"""

import numpy as np
import pytest
from frames import expected_video
from suite.cases import chosen

from cardcage.golden.hard_cases.catalogue import HARD_CASES
from cardcage.golden.reference import bit_true, exact
from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.testbenches.engines.verilator_engine import VerilatorEngine
from cardcage.testbenches.engines.verilator_tool import ToolMissingError, find_verilator
from cardcage.testbenches.frames.simulation import simulate

#: Cards that draw the cases of each size; every case has one of these sizes.
CARDS = {(32, 32): "PMPMMM", (97, 61): "PMM", (1000, 333): "PMM", (640, 480): "PMM"}

#: What each size is drawn with: both coarser precisions by the fifty cases of 32 x 32, and each
#: once where errors add up over a large picture.
PRECISIONS = [((32, 32), "exact"), ((32, 32), 6), ((32, 32), 0), ((97, 61), "exact"),
              ((1000, 333), "exact"), ((1000, 333), 0), ((640, 480), "exact"), ((640, 480), 6)]
#: What most cases have, and the largest errors.
SUITE = ((32, 32), "exact"), ((97, 61), "exact"), ((1000, 333), 0)

LISTS = {name: case.make() for name, case in HARD_CASES.items()}


def cases_of(size):
    return {name: listed for name, listed in LISTS.items()
            if (listed.width, listed.height) == size}


@pytest.fixture(scope="module", autouse=True)
def verilator():
    try:
        find_verilator()
    except ToolMissingError as missing:
        pytest.skip(f"simulator verilator: {missing}")


def test_every_case_has_a_machine():
    assert sum(len(cases_of(size)) for size in CARDS) == len(HARD_CASES)
    assert {size for size, fraction_bits in PRECISIONS if fraction_bits == "exact"} == set(CARDS)


@pytest.mark.parametrize("drawn", chosen(PRECISIONS, *SUITE), ids=str)
def test_every_pixel_of_every_case(drawn, record_property):
    size, fraction_bits = drawn
    cases = cases_of(size)
    bits = fraction_bits
    if fraction_bits == "exact":  # of the case that needs most
        bits = max(map(scene_fraction_bits, cases.values()))
    configuration = MachineConfiguration(
        cards=CARDS[size], width=size[0], height=size[1], fraction_bits=bits, clocks_per_pixel=2)
    engine = VerilatorEngine()
    wrong, pixels = [], 0
    for seed, (name, listed) in enumerate(cases.items()):
        simulation = simulate(configuration, listed, engine, memory_seed=seed)
        models = {"bit-true": bit_true.draw(listed, fraction_bits=bits, shading="gouraud")}
        if fraction_bits == "exact":
            models["exact"] = exact.draw(listed, shading="gouraud")
        for model, picture in models.items():
            color = simulation.video != expected_video(configuration, picture.color)
            depth = simulation.depth != picture.depth
            if color.any() or depth.any():
                wrong.append(f"hard:{name}: {np.count_nonzero(color.any(axis=2))} colours and "
                             f"{np.count_nonzero(depth)} depths differ from {model}, memory seed "
                             f"{seed}")
        pixels += simulation.depth.size
    assert not wrong, "\n".join(wrong)
    count = f"{len(cases)} hard case{'s' * (len(cases) > 1)}"
    record_property("measured", f"{count} at {size[0]}x{size[1]}, {bits} fraction bits "
                    f"({'exact' if fraction_bits == 'exact' else 'coarser'}): {pixels:,} pixels "
                    "of the machine equal golden's, colour and depth")
