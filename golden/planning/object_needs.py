"""What objects ask of a machine that makes their triangles itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..objects.object_words import made_of_objects
from ..specification.commands import layout_bits, mesh_triangle_layout
from ..specification.configuration import MAXIMUM_ORDER_BITS, MachineConfiguration
from ..specification.display_list import DisplayList
from ..specification.errors import InputError
from .plan_line import PlanLine


@dataclass(frozen=True)
class ObjectNeeds:
    """Of the objects of one picture, or the most of several.

    ``objects``    how many
    ``meshes``     how many
    ``triangles``  of all meshes
    ``sub_bits``   the fewest in which each mesh and each offset is whole, not only their sums
    """

    objects: int
    meshes: int
    triangles: int
    sub_bits: int


def needs_of_objects(display_list: DisplayList) -> ObjectNeeds:
    """``InputError`` for a list that is not made of objects."""
    objects = made_of_objects(display_list).objects
    return ObjectNeeds(len(objects.mesh), max(1, len(objects.meshes)),
                       max(1, sum(mesh.triangles for mesh in objects.meshes)),
                       objects.fewest_sub_bits)


def most_of(needs: Sequence[ObjectNeeds]) -> ObjectNeeds:
    return ObjectNeeds(*(max(getattr(each, name) for each in needs)
                         for name in ("objects", "meshes", "triangles", "sub_bits")))


def fields_of_objects(needs: ObjectNeeds, rest: dict[str, Any]) -> dict[str, int]:
    """The fields that are planned for objects, those that are given left out."""
    planned = {"meshes": needs.meshes, "mesh_triangles": needs.triangles}
    if rest["objects"] == "elements":
        planned["order_bits"] = (needs.objects - 1).bit_length() if needs.objects else 0
        if needs.objects >= 1 << MAXIMUM_ORDER_BITS:  # nor can more be counted
            raise InputError(f"objects: elements that pass objects on take "
                             f"{(1 << MAXIMUM_ORDER_BITS) - 1:,} at most, the scene has "
                             f"{needs.objects:,}; have their triangles made at the controller")
    for name in ("meshes", "mesh_triangles"):
        if 0 < rest.get(name, 0) < planned[name]:
            raise InputError(f"{name}: the scene needs {planned[name]:,}; give as many or more, "
                             "or leave it out")
    return {name: number for name, number in planned.items() if not rest.get(name)}


def lines_of_objects(planned: MachineConfiguration, needs: ObjectNeeds) -> list[PlanLine]:
    bits = layout_bits(mesh_triangle_layout(planned))
    places = {"controller": 1, "nodes": planned.nodes, "elements": planned.processing_elements}
    assert planned.objects is not None
    count = places[planned.objects]
    one = {"controller": "the controller", "nodes": "the node", "elements": "the element"}
    where = one[planned.objects] if count == 1 else f"each of {count} {planned.objects}"
    objects = "1 object is" if needs.objects == 1 else f"{needs.objects:,} objects are"
    meshes = "1 mesh" if needs.meshes == 1 else f"{needs.meshes:,} meshes"
    order = [PlanLine("order bits", str(planned.order_bits), "-",
                      "objects come in any order, so each pixel keeps the number of its own")
             ] if planned.keeps_list_order else []
    return [
        *order,
        PlanLine("meshes", f"{planned.meshes:,}", "-",
                 f"{objects} {meshes}, moved"),
        PlanLine("mesh triangles", f"{planned.mesh_triangles:,}", "-",
                 f"of all meshes; {bits} bits each, {planned.mesh_triangles * bits:,} in {where}"),
    ]
