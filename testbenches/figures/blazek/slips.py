"""What the thesis prints that cannot be meant, and what is taken in its place."""

from __future__ import annotations

from dataclasses import dataclass

from ....golden.scenes.built_in.sphere import sphere_triangles
from .his_machine.costs import COSTS
from .our_machine.our_scene import TRIANGLES
from .scenes.sphere_work import CUTS
from .scenes.spheres import SPHERES

#: As they are printed.
POLYGONS = 5102
FRAME_BUFFER = 2_621_440
PACKET_BYTES = 3000

ICOSAHEDRON = 20 << 2 * CUTS


@dataclass(frozen=True)
class Slip:
    """What is ``printed``, why it cannot be so, and what is ``taken``."""

    printed: str
    why: str
    taken: str


def slips() -> list[Slip]:
    """In the order of the thesis."""
    milliseconds = 1000 * COSTS.byte
    fewer, more = sphere_triangles(4), sphere_triangles(5)
    return [
        Slip("messages cost 4 milliseconds per byte, and 275 more above a hundred bytes",
             f"one frame buffer would take {FRAME_BUFFER * milliseconds / 3600:.1f} hours, and a "
             f"packet of 100 polygons {PACKET_BYTES * milliseconds:.0f} seconds",
             "microseconds: a message of 100 bytes then takes 400, one of 101 bytes 679"),
        Slip("an image of 512 × 512, RGB and Z, takes 2,621,440 bytes",
             "24 bits of colour and 32 of depth are 7 bytes a pixel; this is 10",
             "10, since an image of 1024 × 1024 takes “eleven megabytes” too: colours of two bytes "
             "perhaps"),
        Slip("an octahedron has “each of its eight points” on the sphere",
             "it has six points and eight faces", "an octahedron, for our machines"),
        Slip("in a hypercube a message travels N - 1 hops at most", "it is log2 N",
             "no cost of a hop: messages are worm-hole routed"),
        Slip(f"each sphere is made up of {POLYGONS:,} polygons",
             f"an octahedron of which each triangle becomes four has 8 · 4ᵏ: {fewer:,} or "
             f"{more:,}; an icosahedron has {ICOSAHEDRON:,}, the same digits but for their order",
             f"{ICOSAHEDRON:,} on his machine, {TRIANGLES} = 8 · 4³ on ours"),
        Slip("in the largest case over two million polygons",
             f"{SPHERES[-1]:,} · {POLYGONS:,} are {SPHERES[-1] * POLYGONS / 1e6:.1f} million",
             "spheres and polygons as he counts them"),
        Slip("efficiency is the product of speed-up and the number of processors",
             "a perfect speed-up would be n² and not 100 %",
             "speed-up over the number of processors, as his figures must have it"),
    ]
