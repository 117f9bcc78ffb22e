"""``docs/command-words.md`` says of objects what the code does."""

import pytest
from amaranth.lib import data
from command_words_tables import NOTHING, table

from cardcage.golden.organisations.organisation_of import organisation_of
from cardcage.golden.planning.presets import PRESETS
from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Opcode, ResponseKind
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.hdl.backplane import words as layouts
from cardcage.testbenches.frames.conversation import owed_to

OF_OBJECTS = MachineConfiguration(**PRESETS["tiny"] | {"cards": "2x(PMC)"}, setup="hardware",
                                  order_bits=5, objects="nodes", mesh_triangles=8, meshes=6)


def fields(layout, offset, prefix=""):
    for name, field in layout:
        if isinstance(field.shape, data.StructLayout):
            yield from fields(field.shape, offset + field.offset, f"{prefix}{name}.")
        else:
            yield prefix + name, offset + field.offset, field.width


TO_ELEMENTS = MachineConfiguration(
    **PRESETS["tiny"] | {"cards": "2x(PM)"}, setup="hardware", order_bits=5, objects="elements",
    mesh_triangles=8, meshes=6, regions=(4, 2), balance="static")


AT_CONTROLLER = MachineConfiguration(**PRESETS["tiny"] | {"cards": "2x(PM)"}, setup="hardware",
                                     objects="controller", mesh_triangles=8, meshes=6)


@pytest.mark.parametrize(("name", "layout"), [
    ("MESH", commands.mesh_layout), ("OBJECT", commands.object_layout)])
def test_offsets_of_objects(name, layout):
    documented = [(row[f"field of {name}"], int(row["its first bit"]), int(row["its bits"]))
                  for row in table(f"field of {name}")]
    body = layouts.struct_layout(layout(OF_OBJECTS))
    assert documented == list(fields(body, commands.BODY_OFFSET))


def test_offsets_of_objects_to_elements():
    documented = [(row["field of OBJECT to elements"], int(row["its first bit"]),
                   int(row["its bits"])) for row in table("field of OBJECT to elements")]
    body = layouts.struct_layout(commands.object_layout(TO_ELEMENTS))
    assert documented == list(fields(body, commands.BODY_OFFSET))[-2:]


def test_a_triangle_of_a_mesh_has_the_fields_of_a_triangle():
    of_mesh = layouts.struct_layout(commands.mesh_triangle_layout(OF_OBJECTS))
    of_list = layouts.struct_layout(commands.triangle_layout(OF_OBJECTS))
    assert list(fields(of_mesh, 0)) == list(fields(of_list, 0))[:18]


@pytest.mark.parametrize(("column", "configuration"), [
    ("2x(PMC), nodes", OF_OBJECTS), ("2x(PM), elements", TO_ELEMENTS),
    ("2x(PM), controller", AT_CONTROLLER)])
def test_what_a_cage_that_makes_triangles_answers(column, configuration):
    header = "command to a cage that makes triangles"
    for row in table(header):
        owed = owed_to(organisation_of(configuration), commands.command(Opcode[row[header]], 5))
        owed += [(ResponseKind.ERROR, None)] * (row[header] == "OBJECT")  # of no mesh
        assert [kind.name for kind, _ in owed] == row[column].replace(NOTHING, "").split()
