"""Background into every word."""

import pytest
from hdl_bench.bench import Drive, Service, simulate
from hdl_bench.memory import MemoryLines
from hdl_bench.pictures import small_machine
from hdl_bench.streams import no_pause, pauses

from cardcage.hdl.clear import Clear

CONFIGURATION = small_machine("PMMMM", 8, 8)


def clear(*, words, units=(0, 4), front=0, color=0x123456, scan=0.0, seed=0, rounds=1,
          pause=no_pause):
    dut = Clear(configuration=CONFIGURATION)
    memory = MemoryLines(dut.memory, first=units[0], end=units[1], words=CONFIGURATION.words,
                         depth_bits=CONFIGURATION.depth_bits, seed=seed, scan=scan)
    before = {name: dict(getattr(memory, name)) for name in ("depth", "back", "front")}

    def inputs(ctx, clock):
        ctx.set(dut.words, words)
        ctx.set(dut.color, color)
        ctx.set(dut.front, front)

    service = Service(dut, rounds, pause)
    simulate(dut, Drive(inputs), service, memory, after=3)
    expected = {"depth": (1 << CONFIGURATION.depth_bits) - 1, "back": color,
                "front": color if front else None}
    for name, value in expected.items():
        for place, word in getattr(memory, name).items():
            cleared = value is not None and place[1] < words
            assert word == (value if cleared else before[name][place]), (name, place)
    return service, memory


@pytest.mark.parametrize("front", [0, 1])
@pytest.mark.parametrize("units", [(0, 4), (1, 3), (3, 4)])
def test_every_word_of_the_domain_and_no_other(units, front):
    for words in (1, 5, CONFIGURATION.words):
        clear(words=words, units=units, front=front, seed=words)


@pytest.mark.parametrize("seed", range(4))
def test_while_the_scan_takes_ports(seed):
    service, memory = clear(words=11, scan=0.4, seed=seed, rounds=2, pause=pauses(seed))
    assert min(service.clocks) >= 11
    assert len(memory.writes) == 2 * 11
    # Done comes with the last write.
    assert service.ended[-1] == memory.writes[-1][0]


def test_a_word_a_clock():
    service, memory = clear(words=16, rounds=2)
    assert service.clocks == [16, 16]
    assert [write[0] for write in memory.writes[:16]] == list(range(1, 17))


def test_a_domain_without_units_takes_as_long():
    service, _ = clear(words=16, units=(2, 2), scan=0.9)
    assert service.clocks == [16]
