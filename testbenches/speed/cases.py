"""What ``cardcage bench`` draws: the triangles that the peers were measured on, and a mesh."""

from __future__ import annotations

import difflib
import json
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...golden.scene_display_list import make_display_list
from ...golden.specification.display_list import DisplayList
from ...golden.specification.errors import InputError
from ..machine_options import MachineOptions, option_words

#: The screen of every case.
SIZE = 512
SUB_BITS = 8
DEPTH_BITS = 24

#: The one case of which the peers have no figures: a closed mesh of 50,000 to 70,000 triangles.
MESH = "mesh"
MESH_SCENE = "teapot:tessellation=29"

#: A list is repeated until it has at least so many triangles.
LEAST_TRIANGLES = 64

#: In which order the triangles of a case lie behind one another.  ``visible``: each wholly before
#: those drawn earlier, so that every fragment is written; ``random``: the list stays, and who lies
#: where is shuffled.  A mesh keeps its depths: ``visible`` leaves its list as it is, ``random``
#: shuffles that, so that neighbours in the list are no neighbours on the screen.
Order = Literal["visible", "random"]
ORDERS: tuple[Order, ...] = ("visible", "random")

#: What is drawn where no case is named: small, middling and thin ones.
DEFAULT_CASES = ("one_pixel", "right_TL_32", "random_bbox16", "sliver_diag_480")


#: Nothing is asked for of how the mesh is looked at.
AS_IT_IS = MachineOptions()


@dataclass(frozen=True)
class Peer:
    """An open rasteriser, measured on these triangles; what was not measured is None or absent.

    ``short``                a name for a column
    ``setup``                who computes its increments
    ``depth_tested``         whether its figures have a depth test in them
    ``cycles_per_triangle``  by case
    ``ecp5_area``            LUT4 + 2 CCU2C on Lattice ECP5
    ``ecp5_mhz``             least and greatest routed clock
    ``depth_error_lsb``      least and greatest error on a 500-pixel triangle, of 16 bits
    """

    name: str
    short: str
    setup: str
    depth_tested: bool
    cycles_per_triangle: dict[str, float]
    ecp5_area: int | None
    ecp5_mhz: list[float] | None
    depth_error_lsb: list[float] | None


@dataclass(frozen=True, eq=False)
class CaseLists:
    """``once`` has n triangles, ``twice`` 2n, drawn after it in the same frame; ``looking``: what
    of the mesh was asked for."""

    name: str
    order: Order
    once: DisplayList
    twice: DisplayList
    looking: MachineOptions = AS_IT_IS

    @property
    def title(self) -> str:
        """The name, and what was asked for besides."""
        return " ".join([self.name, *option_words(self.looking)])

    def repeated(self, times: int) -> CaseLists:
        """The same, with a list that is so many times as long, where there is one."""
        return case_lists(self.name, self.order, times=times, looking=self.looking)

    @property
    def frame(self) -> DisplayList:
        """Both, as the finished picture has them."""
        return self.once.followed_by(self.twice)


def _data(name: str) -> Any:
    path = resources.files("cardcage.testbenches") / "data" / name
    return json.loads(path.read_text(encoding="utf-8"))


def peers() -> tuple[Peer, ...]:
    """The open rasterisers that the same triangles were measured on."""
    return tuple(Peer(name=name, **facts) for name, facts in _data("peers.json")["peers"].items())


@cache
def _triangles() -> dict[str, NDArray[np.int32]]:
    return {name: np.array(triangles, np.int32)
            for name, triangles in _data("peer_cases.json")["cases"].items()}


def case_names() -> tuple[str, ...]:
    return (*_triangles(), MESH)


def check_case(name: str) -> str:
    """``name`` itself; ``InputError`` with close ones where there is no such case."""
    if name not in case_names():
        close = difflib.get_close_matches(name, case_names(), 3, 0.3) or case_names()
        raise InputError(f"case: there is no {name!r}; take {' or '.join(close)}")
    return name


def case_lists(name: str, order: Order = "visible", seed: int = 1, times: int = 1,
               looking: MachineOptions = AS_IT_IS) -> CaseLists:
    """The display lists of a case, of flat colours; ``InputError`` for an unknown name, and where
    triangles that are made on the screen are to be looked at in another way.

    A peers' list is repeated until it has ``LEAST_TRIANGLES``, and all that ``times`` over; the
    mesh is one pass whatever ``times`` says.

    The peers' triangles have their vertices on pixel centres and no depth.  Here triangle i of
    3n has a slot of depths to itself, and slopes through all of it.  A mesh has depths: each of
    its three passes is moved into a third of the range, before the one before.  Its shuffled list
    is the same in all three; a triangle's number is its place in there, as in any list.
    """
    check_case(name)
    random = np.random.default_rng([seed, ORDERS.index(order)])
    if name == MESH:
        once, twice = _mesh(order, random, looking)
    elif looking != AS_IT_IS:
        raise InputError(f"{option_words(looking)[0]}: the triangles of {name} are made on the "
                         f"screen; leave it out, or take the case {MESH} alone")
    else:
        once, twice = _repeated(_triangles()[name], times, order, random)
    return CaseLists(name, order, once, twice, looking)


def _list(position: NDArray[np.int32], depth: NDArray[np.int64], color: NDArray[np.uint8],
          background: tuple[int, int, int] = (0, 0, 0)) -> DisplayList:
    return DisplayList(SIZE, SIZE, position, depth, color, SUB_BITS, DEPTH_BITS, background)


def _repeated(triangles: NDArray[np.int32], times: int, order: Order,
              random: np.random.Generator) -> tuple[DisplayList, DisplayList]:
    least = max(LEAST_TRIANGLES, len(triangles))
    once = -(-least // len(triangles)) * len(triangles) * times
    total = 3 * once
    position = np.tile(triangles, (total // len(triangles), 1, 1))
    position = (position << SUB_BITS) + (1 << (SUB_BITS - 1))
    thickness = ((1 << DEPTH_BITS) - 1) // total
    # Slots from far to near: the first triangle is behind all others.
    slot = np.arange(total)[::-1] if order == "visible" else random.permutation(total)
    slopes = np.array([0, thickness // 2, thickness - 1])
    depth = slot[:, np.newaxis] * thickness + random.permuted(np.tile(slopes, (total, 1)), axis=1)
    # Brighter than the background, which is black.
    color = random.integers(64, 256, (total, 1, 3), np.uint8).repeat(3, axis=1)
    return (_list(position[:once], depth[:once], color[:once]),
            _list(position[once:], depth[once:], color[once:]))


def _mesh(order: Order, random: np.random.Generator, looking: MachineOptions
          ) -> tuple[DisplayList, DisplayList]:
    asked = {**looking.looking(), "background": looking.background or (0, 0, 0)}
    mesh = make_display_list(MESH_SCENE, width=SIZE, height=SIZE, sub_bits=SUB_BITS,
                             depth_bits=DEPTH_BITS, shading="flat", **asked).display_list
    shuffled = np.arange(mesh.triangles)
    if order == "random":
        random.shuffle(shuffled)
    third = ((1 << DEPTH_BITS) - 1) // 3
    passes = [_list(mesh.position[shuffled], mesh.depth[shuffled] // 3 + (2 - turn) * third,
                    mesh.color[shuffled], mesh.background) for turn in range(3)]
    once, second, third_pass = passes
    return once, second.followed_by(third_pass)
