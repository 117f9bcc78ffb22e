"""Objects that a machine refuses, between frames that it draws."""

import numpy as np

from cardcage.golden.specification import commands
from cardcage.golden.specification.commands import Fault, Opcode, ResponseKind

#: Of ``refused_objects``.
FRAMES = 6


def refused_objects(configuration, good, redrawn):
    """Commands of six frames, and of each the faults that answer them: of a mesh that was not
    loaded, and of any while some mesh found no room, even those that were loaded; whole frames
    before and after.

    ``good``     loads meshes and draws a frame
    ``redrawn``  the frame alone
    """
    clear, load, begin = (commands.command(opcode) for opcode in (
        Opcode.CLEAR_LISTS, Opcode.MESH_TRIANGLE, Opcode.MESH))
    mesh_7 = commands.command(Opcode.OBJECT, 7)
    many = [clear, begin, *[load] * (configuration.mesh_triangles + 1)]
    start, *drawing, end = redrawn
    whole = [word for word in drawing if commands.opcode_of(word) == Opcode.OBJECT]
    return [(good, []), ([start, mesh_7, *drawing, end], [Fault.NO_MESH]),
            ([*many, start, *whole, end], [Fault.LIST_FULL] * len(whole)),
            ([clear, *[begin] * (configuration.meshes + 1), start, mesh_7, end],
             [Fault.LIST_FULL]),
            ([clear, load, begin, start, mesh_7, end], [Fault.NO_MESH]), (good, [])]


def check_refused(answered, cases, background):
    """What answered ``cases``, of which those of ``refused_objects`` come first: the faults, and
    pictures that are whole or empty."""
    faults = [value for kind, value, _ in answered.responses if kind == ResponseKind.ERROR]
    assert faults == [fault for _, some in cases for fault in some]
    shown = [cycle for kind, _, cycle in answered.responses if kind == ResponseKind.FRAME_SHOWN]
    pictures = [next(scan.picture for scan in answered.scans if scan.cycle > cycle)
                for cycle in shown[:FRAMES]]
    for number in (1, 5):
        np.testing.assert_array_equal(pictures[number], pictures[0])
    for number in (2, 3, 4):
        assert (pictures[number] == background).all()
