"""Machines that deal regions out made wrong, each in one way: three pictures in a row tell."""

import importlib
import inspect
import types
from dataclasses import replace

import pytest
from frames import PIXEL, SCREEN, joined, random_list, triangles
from suite.cases import EVERY, chosen

from cardcage.golden.planning.machine_plan import plan
from cardcage.testbenches.engines import choose_engine
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.sequence.sequence_run import simulate_sequence
from cardcage.testbenches.support.machine_error import MachineError

#: One triangle covers the screen, so that its box is a large one; then so many that the picture is
#: late; then few, in one corner.
LISTS = [joined(triangles([SCREEN], [[3000] * 3], [[[9, 8, 7]] * 3]), random_list(5, 6, flat=True)),
         random_list(6, 70, flat=True),
         triangles([PIXEL] * 20, [[n, n, n] for n in range(20)], [[[1, 250, 3]] * 3] * 20)]

HOST = {"cards": "3x(PM)", "regions": (4, 4)}
HARDWARE = HOST | {"balancer": "hardware"}

#: What is wrong → machine, module, right text, wrong text.
MUTANTS = {
    "the scan looks up by the table of the picture that is drawn": (
        HOST, "hdl.controller.region_node", "controller.shown_table.eq(table.shown)",
        "controller.shown_table.eq(table.lines.table)"),
    "the scan goes on by the table of the picture before": (
        HOST, "hdl.controller.region_node", "self.table.swap.eq(1)", "self.table.swap.eq(0)"),
    "elements draw by the table that comes": (
        HOST, "hdl.regions.own_regions", "half[1]), lines.table)", "half[1]), lines.bank)"),
    "elements have the slots of the picture before": (
        HOST, "hdl.regions.region_rows", "coming.row, lines.table)", "coming.row, lines.bank)"),
    "a slot one too high": (
        HOST, "hdl.controller.region_table", "lines.slot.eq(slot)", "lines.slot.eq(slot + 1)"),
    "a slot one too high in the scan alone": (
        HOST, "hdl.video.region_places", "write.data.slot.eq(lines.slot)",
        "write.data.slot.eq(lines.slot + 1)"),
    "of two visits of a slot, one behind the other, one is not counted": (
        HOST, "hdl.regions.region_counts", "again.eq(adds & (adds_to == slot))", "again.eq(0)"),
    "empty rows are not counted": (
        HOST, "hdl.regions.region_counts", "rows.eq(Mux(anew, 0, rows) + 1)",
        "rows.eq(Mux(anew, 0, rows) + (row.pixels != 0))"),
    "counts go on from the last picture": (
        HOST, "hdl.regions.region_counts", "m.d.sync += counted.eq(0)", "pass"),
    "the lightest region comes first": (
        HARDWARE, "hdl.balancing.merge_sorter", "left.first.weight >= right.first.weight",
        "left.first.weight <= right.first.weight"),
    "of equal regions the highest comes first": (
        HARDWARE, "hdl.balancing.merge_sorter", "left.first.weight >= right.first.weight",
        "left.first.weight > right.first.weight"),
    "an element with no slot left gets one more": (
        HARDWARE | {"slots": 6}, "hdl.balancing.least_loaded",
        "with m.If(answers & (read.data.held != self.slots)", "with m.If(answers"),
    "a box ends a column of pixels early": (
        HOST, "hdl.regions.region_box", "right=(box.right - 1)[", "right=(box.right - 2)["),
    "a box reaches what it only touches": (
        HOST, "hdl.regions.region_box", "bottom=(box.bottom - 1)[", "bottom=box.bottom["),
    "boxes of two columns of regions are taken for boxes of one": (
        HOST, "hdl.regions.region_filter", "wide.eq(box.left != box.right)", "wide.eq(0)"),
    "a late picture is shown a scan longer than is said": (
        HOST, "hdl.controller.one_node", "shown.eq(controller.scans)",
        "shown.eq(controller.scans - 1)"),
    "a late picture is dropped": (
        HOST, "hdl.controller.one_node", "pictures.front.eq(~pictures.front)",
        "pictures.front.eq(pictures.front ^ (controller.scans < 2))"),
}

#: How a machine that is wrong shows.
FAILURES = (AssertionError, MachineError, StopIteration)


class Impatient(PysimEngine):
    """One that hangs is not waited for."""

    def run(self, job, progress=None):
        return super().run(replace(job, maximum_cycles=20_000), progress)


def functions(namespace, module):
    """Those of a module and of its classes, by name."""
    for name, found in namespace.items():
        if inspect.isclass(found) and found.__module__ == module:
            yield from ((f"{name}.{inner}", function)
                        for inner, function in functions(vars(found), module))
        elif isinstance(found, types.FunctionType) and found.__module__ == module:
            yield name, found


def make_wrong(monkeypatch, name, right, wrong):
    """Put ``wrong`` in the place of ``right``, which is in the module once, within its functions:
    whoever uses these, or inherits them, gets the wrong ones."""
    module = importlib.import_module(f"cardcage.{name}")
    source = inspect.getsource(module)
    assert source.count(right) == 1, f"{right!r} is in {name} {source.count(right)} times"
    mutant = types.ModuleType(module.__name__)
    mutant.__package__ = module.__package__
    exec(compile(source.replace(right, wrong), module.__file__, "exec"), mutant.__dict__)
    changed = dict(functions(vars(mutant), module.__name__))
    for place, function in functions(vars(module), module.__name__):
        monkeypatch.setattr(function, "__code__", changed[place].__code__)


@pytest.fixture(autouse=True)
def impatient(monkeypatch):
    monkeypatch.setattr(choose_engine, "ENGINES", {"pysim": Impatient})


def check(fields):
    configuration = plan(LISTS, **fields, clocks_per_pixel=2, tag_bits=2).configuration
    frames = list(simulate_sequence(configuration, LISTS, "pysim", triangles=70, depths="all",
                                    policy=configuration.balance, memory_seed=3))
    for frame in frames:
        assert frame.equal and not frame.regions.differences, frame.number
    assert frames[1].simulation.repeated_scans >= 1


@pytest.mark.parametrize("fields", [
    HOST, pytest.param(HARDWARE, marks=EVERY),
    pytest.param(HARDWARE | {"slots": 6}, marks=EVERY)], ids=str)
def test_the_machine_itself(fields):
    check(fields)


@pytest.mark.parametrize("name", chosen(
    MUTANTS, "a slot one too high", "a late picture is dropped"))
def test_each_is_noticed(monkeypatch, name):
    fields, *change = MUTANTS[name]
    make_wrong(monkeypatch, *change)
    with pytest.raises(FAILURES):
        check(fields)
