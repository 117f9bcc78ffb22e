"""``docs/command-words.md`` says what the code does."""

import re
from math import ceil

import numpy as np
import pytest
from amaranth.hdl import Const
from amaranth.lib import data
from command_words_tables import DOCUMENT, NOTHING, TABLES, table
from hdl_bench.bench import simulate
from hdl_bench.cage import Run
from hdl_bench.pictures import exact_words
from hdl_bench.streams import Sink, Source

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.reference import exact, triangle_words
from cardcage.golden.reference import triangle_setup as setup
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.display_list import DisplayList
from cardcage.hdl.backplane import words as layouts
from cardcage.hdl.backplane.words import Operation
from cardcage.hdl.machine import Machine
from cardcage.testbenches.engines.engine import Job
from cardcage.testbenches.engines.pysim_engine import PysimEngine
from cardcage.testbenches.frames.conversation import owed_at_boot, owed_to

TINY = MachineConfiguration(**PRESETS["tiny"])


def symbols(configuration):
    return {"W": configuration.width, "H": configuration.height, "s": configuration.sub_bits,
            "d": configuration.depth_bits, "F": configuration.fraction_bits,
            "b": configuration.coordinate_bits, "X": configuration.x_bits,
            "Y": configuration.y_bits, "C": configuration.edge_column_bits,
            "R": configuration.edge_height_bits, "E": configuration.edge_word_bits,
            "D": configuration.depth_plane_bits, "K": configuration.channel_plane_bits,
            "O": configuration.order_bits, "Q": configuration.round_bits,
            "N": configuration.node_bits, "I": configuration.mesh_bits}


def test_title_has_the_version():
    title = DOCUMENT.read_text(encoding="utf-8").splitlines()[0]
    assert re.fullmatch(rf"# .*, version {commands.VERSION}", title)


def test_symbols():
    values = symbols(TINY)
    for row in table("symbol"):
        (*numbers,) = map(int, row["tiny"].split(","))
        assert numbers == [values[name] for name in row["symbol"].split(", ")]
    named = {name for row in table("symbol") for name in row["symbol"].split(", ")}
    assert named == set(values)


CONFIGURATIONS = {
    "tiny": TINY,
    "paper": MachineConfiguration(**PRESETS["paper"]),
    "flat": MachineConfiguration(**PRESETS["tiny"], shading="flat"),
    "coarse fractions": MachineConfiguration("PM", 300, 40, sub_bits=3, depth_bits=16,
                                             fraction_bits=0),
    "guard": MachineConfiguration("PM", 16, 17, fraction_bits=6),
    "no guard": MachineConfiguration("PM", 16, 17, fraction_bits=7),
    "nodes": MachineConfiguration("3x(PMT)", 16, 17, fraction_bits=6, maximum_nodes=9),
    "nodes, few fractions": MachineConfiguration("2x(PMC)", 300, 40, sub_bits=3, fraction_bits=0,
                                                 order_bits=5),
    "direct": MachineConfiguration("3xPD2xM", 16, 17, fraction_bits=6, maximum_nodes=9,
                                   order_bits=13),
    "direct, without rounds": MachineConfiguration("2xPDM", 16, 17, fraction_bits=0,
                                                   packet="contiguous"),
    "direct, few fractions": MachineConfiguration("2xPD2xM", 300, 40, sub_bits=3, fraction_bits=0,
                                                  order_bits=5),
    "flat, least": MachineConfiguration("PM", 1, 1, sub_bits=1, depth_bits=2, fraction_bits=0,
                                        shading="flat"),
}


def test_some_machines_have_guard_bits_and_some_have_none():
    assert {name for name, machine in CONFIGURATIONS.items() if machine.stays_in_range} == {
        "tiny", "paper", "flat", "no guard"}


@pytest.mark.parametrize("name", CONFIGURATIONS)
def test_width_formulas(name):
    configuration = CONFIGURATIONS[name]
    values = symbols(configuration)
    (width, height, s, d, fraction, b, x, y, c, r, e, depth, channel, order, rounds,
     node, _) = values.values()

    def guard(v):
        g = 0
        if 2 * (width + height - 1) < 2**fraction:
            return g
        while 2**v + ceil((width + height - 1) / 2 ** (fraction + 1)) > 2 ** (v + g - 1):
            g += 1
        return g

    assert b == (max(width, height) - 1).bit_length() + 2 + s
    assert (x, y) == (width.bit_length(), height.bit_length())
    assert (c, r) == (b - s + 1, b)
    assert e == c + ((2**r - 1) * height).bit_length()
    assert depth == d + guard(d) + fraction
    assert channel == 8 + guard(8) + fraction
    colors = 24 if configuration.shading == "flat" else 9 * channel
    planes = 8 + 3 * y + 2 * x + 1 + 6 * e
    vertices = 8 + 3 * (2 * b + d + 24)  # the longer body where few fraction bits are carried
    last = (configuration.maximum_nodes - 1).bit_length() if configuration.merges_directly else 0
    assert rounds == max(0, order - last)
    assert commands.prepared_triangle_layout(configuration)["planes"].get("round", 0) == rounds
    assert commands.triangle_layout(configuration).get("round", 0) == rounds
    longest = max(planes + 3 * depth + colors, vertices) + rounds + node
    assert node == (configuration.maximum_nodes.bit_length() if configuration.merge else 0)
    assert commands.command_words(configuration) == -(-longest // 32)
    if name == "tiny":
        text = DOCUMENT.read_text(encoding="utf-8")
        assert f"    {planes} = 8 + 3·Y + 2·X + 1 + 6·E\n" in text
        assert f"= {commands.command_words(configuration)}\n" in text


def hardware_fields(layout, offset, prefix=""):
    for name, field in layout:
        if isinstance(field.shape, data.StructLayout):
            yield from hardware_fields(field.shape, offset + field.offset, f"{prefix}{name}.")
        else:
            yield prefix + name, offset + field.offset, field.width


def test_prepared_triangle_offsets():
    rows = table("field", "tiny: first bit")
    documented = [(row["field"], int(row["tiny: first bit"]), int(row["tiny: bits"]))
                  for row in rows]
    hardware = layouts.prepared_triangle_layout(TINY)
    assert documented == list(hardware_fields(hardware, commands.BODY_OFFSET))
    offset = commands.BODY_OFFSET
    flat = []

    def walk(layout, prefix=""):
        nonlocal offset
        for name, entry in layout.items():
            if isinstance(entry, int):
                flat.append((prefix + name, offset, entry))
                offset += entry
            else:
                walk(entry, f"{prefix}{name}.")

    walk(commands.prepared_triangle_layout(TINY))
    assert documented == flat
    values = symbols(TINY)
    for row in rows:
        assert int(row["tiny: bits"]) == values.get(row["bits"], 1)
        assert row["bits"] in values or row["bits"] == "1"


def test_triangle_offsets():
    documented = [(row["field, tiny"], int(row["first bit"]), int(row["bits"]))
                  for row in table("field, tiny", "first bit")]
    hardware = list(hardware_fields(layouts.struct_layout(commands.triangle_layout(TINY)),
                                    commands.BODY_OFFSET))
    assert documented == hardware[:6] and len(hardware) == 18
    vertex = documented[-1][1] + documented[-1][2] - commands.BODY_OFFSET
    assert [offset for _, offset, _ in hardware[6:12]] == [
        offset + vertex for _, offset, _ in documented]
    assert f"Vertices 1 and 2 follow, {vertex} bits each." in DOCUMENT.read_text(encoding="utf-8")


def of_nodes(cards):
    return MachineConfiguration(**PRESETS["tiny"] | {"cards": cards}, order_bits=5, list_words=8)


OF_NODES = of_nodes("2x(PMC)")


def test_the_last_fields_of_a_triangle_are_its_share():
    rows = table("last fields", "their bits")
    assert [row["bits"] for row in rows] == ["Q", "N"]
    for name, layout in (("PREPARED_TRIANGLE", commands.prepared_triangle_layout(OF_NODES)),
                         ("TRIANGLE", commands.triangle_layout(OF_NODES))):
        documented = [(row["last fields"].split(".")[-1], int(row[f"{name}: first bit"]),
                       int(row["their bits"])) for row in rows]
        *_, share, node = hardware_fields(layouts.struct_layout(layout), commands.BODY_OFFSET)
        assert documented == [(share[0].split(".")[-1], *share[1:]), node]
    [planes] = [path for path, *_ in hardware_fields(
        layouts.prepared_triangle_layout(OF_NODES), 0) if path.endswith("round")]
    assert planes == rows[0]["last fields"]
    direct = of_nodes("2xPD2xM")
    assert f"`planes.round` has {direct.round_bits}." in DOCUMENT.read_text(encoding="utf-8")


@pytest.mark.parametrize("cards", ["2x(PMC)", "2x(PMS)F", "2xPD2xM"])
def test_what_a_cage_of_nodes_answers(cards):
    """At boot, and to each command, as the page has it."""
    organisation = organisation_of(of_nodes(cards))
    boot = [(kind.name, NOTHING if value is None else f"0x{value:08x}")
            for kind, value in owed_at_boot(organisation)]
    header = f"{cards} boots with"
    assert boot == [(row[header], row["value"]) for row in table(header)]
    header = "command to a cage with lists"
    answers = {row[header]: row[cards].replace(NOTHING, "").split() for row in table(header)}
    assert set(Opcode.__members__) - set(answers) == {"READ_DEPTH"}
    for name, kinds in answers.items():
        owed = owed_to(organisation, commands.command(Opcode[name]))
        assert [kind.name for kind, _ in owed] == kinds


def of_regions(**changes):
    return MachineConfiguration(**PRESETS["tiny"] | {"cards": "3x(PM)"}, regions=(4, 2), **changes)


def test_region_offsets():
    documented = [(row["field of REGION"], int(row["where it begins"]), int(row["how long"]))
                  for row in table("field of REGION")]
    body = layouts.struct_layout(commands.region_layout(of_regions()))
    assert documented == list(hardware_fields(body, commands.BODY_OFFSET))


def test_what_a_cage_with_regions_answers():
    """Of each kind of response at least one; how many ``owed_to`` says."""
    header = "command to a cage with regions"
    for balancer, balance in (("host", "clocks"), ("host", "static"), ("hardware", "clocks")):
        organisation = organisation_of(of_regions(balancer=balancer, balance=balance))
        for row in table(header):
            word = commands.command(Opcode[row[header]])
            owed = [kind.name for kind, _ in owed_to(organisation, word)]
            documented = row[f"{balancer}, {balance}"].replace(NOTHING, "").split()
            assert list(dict.fromkeys(owed)) == documented


def test_where_a_pixel_of_a_region_lies():
    """The formulas of the page, with the interlace that it has for one processing element."""
    configuration = of_regions(memory_ports=2)
    organisation = organisation_of(configuration).dealt([2, 0, 0, 1, 2, 2, 1, 0])
    regions, inside = configuration.dealt_regions, configuration.interlace
    i, j, u = regions.x_bits, regions.y_bits, configuration.share_bits
    assert configuration.words == configuration.slots * 2**(i + j - u)
    y, x = (axis.ravel() for axis in np.mgrid[:16, :16])
    r = y // 2**j * regions.columns + x // 2**i
    slot = np.array([0, 0, 1, 0, 1, 2, 1, 2])[r]
    place = x % 2**i, y % 2**j
    np.testing.assert_array_equal(
        organisation.unit(x, y), organisation.table[r] * 2**u + inside.unit(*place))
    np.testing.assert_array_equal(
        organisation.word(x, y), slot * 2**(i + j - u) + inside.address(*place))


def test_the_fault_of_a_wrong_region():
    """The page's numbers are those of the faults that the machine answers."""
    rows = table("ERROR", "the region")
    assert [Fault(int(row["ERROR"])) for row in rows] == [
        Fault.TABLE_LATE, Fault.REGION_TWICE, Fault.REGION_TO_NOBODY, Fault.NO_SLOT]


def test_frame_start_offsets():
    documented = [(row["field"], int(row["first bit"]), int(row["bits"]))
                  for row in table("field", "first bit")]
    body = layouts.struct_layout(commands.frame_start_layout())
    assert documented == list(hardware_fields(body, commands.BODY_OFFSET))


def test_response_word():
    layout = layouts.response_layout()
    assert layout.size == 40
    assert "| 0 … 7 | kind |" in DOCUMENT.read_text(encoding="utf-8")
    assert list(hardware_fields(layout, 0)) == [("kind", 0, 8), ("value", 8, 32)]


def documented_fields(value):
    """(name, first bit, bits) of each field that a cell names, in its order."""
    fields = [(name, int(first), int(last) - int(first) + 1) for name, first, last in
              re.findall(r"(\w+) \(bits (\d+) … (\d+)\)", value)]
    return fields or [(value.split(":")[0], 0, 32)]


@pytest.mark.parametrize("kind", ResponseKind)
def test_response_values(kind):
    [row] = [row for row in table("kind", "name", "value") if row["name"] == kind.name]
    fields = layouts.response_fields(kind, Const(0, 32)).shape()
    assert documented_fields(row["value"]) == list(hardware_fields(fields, 0))


@pytest.mark.parametrize(("column", "kinds", "others"), [
    ("opcode", Opcode, {"others": NOTHING}), ("kind", ResponseKind, {}), ("fault", Fault, {})])
def test_numbers(column, kinds, others):
    (rows,) = [rows for header, rows in TABLES.items() if header[:2] == (column, "name")]
    documented = {row["name"]: row[column] for row in rows}
    named = {name: int(number) for name, number in documented.items() if name != NOTHING}
    assert named == {kind.name: int(kind) for kind in kinds}
    assert {number: name for name, number in documented.items() if name == NOTHING} == others


def example():
    rows = table("vertex")

    def column(*names):
        return [[int(row[name]) for name in names] for row in rows]

    for row in rows:
        for axis in "xy":
            assert float(row[f"{axis} (pixels)"]) * 256 == int(row[f"{axis} (units)"])
    return DisplayList(
        width=16, height=16, background=(0, 0, 64),
        position=np.array([column("x (units)", "y (units)")], np.int32),
        depth=np.array([[depth for (depth,) in column("depth")]], np.int64),
        color=np.array([column("red", "green", "blue")], np.uint8))


def documented_commands():
    """Name → the command as one number."""
    found = {}
    for row in table("command", "words"):
        words = [int(word, 16) for word in row["words"].split()]
        assert len(words) <= commands.command_words(TINY)
        found[row["command"].split(",")[0]] = sum(word << 32 * place
                                                  for place, word in enumerate(words))
    return found


def test_example_words():
    scene = example()
    prepared = setup.prepare(scene, fraction_bits=TINY.fraction_bits)
    (word,) = triangle_words.prepared_triangles(TINY, prepared)
    assert documented_commands() == {
        "FRAME_START": commands.frame_start(scene.background),
        "PREPARED_TRIANGLE": word,
        "FRAME_END": commands.command(Opcode.FRAME_END),
        "READ_DEPTH": commands.command(Opcode.READ_DEPTH)}
    for row in table("field", "tiny: example"):
        first, bits = int(row["tiny: first bit"]), int(row["tiny: bits"])
        assert word >> first & (1 << bits) - 1 == int(row["tiny: example"], 16), row["field"]


def test_example_on_the_machine():
    """The words of the page, sent to the machine of the page."""
    scene = example()
    machine = Machine(configuration=TINY)
    boot = table("response word")
    sink = Sink(machine.responses, len(boot) + 1 + 2 + 256)
    simulate(machine, Source(machine.commands, documented_commands().values()), sink)
    answers = [(ResponseKind(item.kind), item.value) for item in sink.items]
    for answer, row in zip(answers, boot, strict=False):
        assert answer == (ResponseKind[row["kind"]], int(row["value"], 16))
        assert int(row["response word"], 16) == answer[0] | answer[1] << 8
    kinds = [kind for kind, _ in answers[len(boot):]]
    assert kinds == [ResponseKind.BOOTED, ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN,
                     *[ResponseKind.DEPTH] * 256]
    depths = [value for _, value in answers[-256:]]
    drawn, _ = exact_words(scene, TINY.interlace, flat=False)
    assert depths == [drawn.get((x, y), (2**24 - 1,))[0] for y in range(16) for x in range(16)]
    assert (5, 5) in drawn  # the pixel that the page points at
    assert "pixel (5, 5) is\nword 5 · 16 + 5 = 85" in DOCUMENT.read_text(encoding="utf-8")


def test_rows_that_are_out_of_range():
    """What the page says goes on from the controller does."""
    layout = commands.prepared_triangle_layout(TINY)
    good = documented_commands()["PREPARED_TRIANGLE"] >> commands.BODY_OFFSET
    rows = table("row or column")
    assert {row["row or column"] for row in rows} == {"top", "middle", "bottom", "left", "right"}
    sent = [commands.unpack(layout, good) | {row["row or column"]: int(row["sent"])}
            for row in rows]
    told = [values | {row["row or column"]: int(row["told to the processing elements"])}
            for values, row in zip(sent, rows, strict=True)]
    words = [commands.command(Opcode.PREPARED_TRIANGLE, commands.pack(layout, values))
             for values in sent]
    run = Run(TINY, words, 4, domains=[(0, 1)])
    packets = map(run.fields, range(1, 1 + len(words)))  # after the survey
    assert [(operation, commands.unpack(layout, body)) for operation, body in packets] == [
        (Operation.DRAW, values) for values in told]


def test_commands_that_are_out_of_order():
    """The answers are those of the page, and the example after them is exact."""
    known = documented_commands() | {"TRIANGLE": commands.command(Opcode.TRIANGLE)}
    words, kinds = [], []
    for row in table("sent", "answers"):
        names = re.findall(r"[A-Z_]{4,}|\b\d+", row["sent"].split(",")[0])
        words += [int(name) if name.isdigit() else known[name] for name in names]
        for kind in re.findall(r"[A-Z_]{4,}", row["answers"]):
            kinds += [ResponseKind[kind]] * (256 if kind == "DEPTH" else 1)
    words += documented_commands().values()
    kinds += [ResponseKind.FRAME_DRAWN, ResponseKind.FRAME_SHOWN, *[ResponseKind.DEPTH] * 256]
    job = Job(TINY, words, 4 + len(kinds), memory_seed=1, maximum_cycles=40_000)
    run = PysimEngine().run(job)
    assert [kind for kind, *_ in run.responses][4:] == kinds
    drawn, _ = exact_words(example(), TINY.interlace, flat=False)
    depths = [value for _, value, _ in run.responses[-256:]]
    assert depths == [drawn.get((x, y), (2**24 - 1,))[0] for y in range(16) for x in range(16)]
    picture = exact.draw(example())
    np.testing.assert_array_equal(run.scans[-1].picture, picture.color)
