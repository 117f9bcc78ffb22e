"""Mutants that no test should kill: they do what the right program does, or serve as well."""

from __future__ import annotations

from typing import NamedTuple


class Equivalent(NamedTuple):
    """A file, the text of a line in it, what is changed to what there, and why that is as good."""

    file: str
    text: str
    change: str
    why: str


_SCENE = "A corner of a scene: what the case is to show, it shows as well."
_WIDER = "A bit more than is needed repeats the sign, or is 0."

EQUIVALENT = (
    Equivalent(
        "golden/cycles/element_spans.py", "for x_offset in range(1 << x_bits):",
        "1 << x_bits → 2 << x_bits", "No block has an offset beyond its distance."),
    Equivalent(
        "golden/cycles/frame_clocks.py",
        "per_command = (6 + 3 * steps) * pixels + 16 * configuration.height + 64 + divisions",
        "(6 + 3 * steps) * pixels + 16 * configuration.height + 64 → "
        "(6 + 3 * steps) * pixels + 16 * configuration.height + 65",
        "A margin: beyond it a machine is said to hang."),
    Equivalent(
        "golden/hard_cases/coordinate_range.py",
        "[[-25, 8], [8, -25], [-25, -25]], [[57, 8], [24, -25], [57, -25]],", "-25 → -24", _SCENE),
    Equivalent(
        "golden/hard_cases/coverage.py",
        "points[1:-1, 1:-1] += (RandomNumbers(5).integers(5, 5, 5, 2) - 2) / 2",
        "RandomNumbers(5).integers(5, 5, 5, 2) → RandomNumbers(5).integers(4, 5, 5, 2)", _SCENE),
    *(Equivalent(
        "golden/hard_cases/sizes.py",
        "return screen_list(fan((width // 2 + 0.5, height // 3 + 0.5), ring), width=width,", change,
        _SCENE)
      for change in ("width // 2 + 0.5 → width // 2 - 0.5", "width // 2 → width // 3",
                     "width // 2 → width // 1", "height // 3 + 0.5 → height // 3 - 0.5",
                     "height // 3 → height // 4", "height // 3 → height // 2")),
    Equivalent(
        "golden/hard_cases/whole_lists.py",
        "+ (numbers.integers(20 * 256, count, 3, 2) - 10 * 256) / 256)", "10 * 256 → 9 * 256",
        _SCENE),
    Equivalent(
        "golden/hard_cases/whole_lists.py",
        "return screen_list(corners, 1000 + numbers.integers(4, count))",
        "numbers.integers(4, count) → numbers.integers(5, count)",
        "A depth more in a scene: the ties that the case is about are as many but for a fifth."),
    Equivalent(
        "golden/scenes/mesh_files/ply/rows.py",
        "if (first != length).any() or not 0 <= length <= values.shape[1] - at:",
        "0 <= length <= values.shape[1] - at → 1 <= length <= values.shape[1] - at",
        "Empty lists are then read row by row, to the same."),
    Equivalent(
        "golden/scenes/mesh_files/stl.py",
        'self._refuse(start + int(words[last]) - 1, "a facet outside of a solid")',
        "start + int(words[last]) - 1 → start + int(words[last]) - 0",
        "The next letter is on the same line, and only the line is said."),
    *(Equivalent(
        "golden/precision/edge_functions.py",
        "high = np.clip(np.ceil(np.clip(position.max(axis=1), -2, size + 2)) + 1, 0, size)", change,
        "The box is a pixel wider than it need be, and what of it is off the screen is cut away.")
      for change in (
          "np.ceil(np.clip(position.max(axis=1), -2, size + 2)) + 1 → "
          "np.ceil(np.clip(position.max(axis=1), -2, size + 2)) + 0",
          "np.ceil(np.clip(position.max(axis=1), -2, size + 2)) + 1 → "
          "np.ceil(np.clip(position.max(axis=1), -2, size + 2)) + 2",
          "size + 2 → size + 1", "size + 2 → size + 3", "-2 → -3", "-2 → -1", "-2 → 2")),
    *(Equivalent(
        "hdl/arithmetic/divider.py", "if self._interval > 1:", f"self._interval > 1 → {wrong}",
        "Where each clock is a stage, nobody reads what a stage makes of nothing.")
      for wrong in ("self._interval >= 1", "self._interval > 0", "True")),
    Equivalent(
        "hdl/arithmetic/delay.py",
        "def delayed(m: Module, value, clocks: int, name: str, *, reset_less: bool = True, "
        "enable=1):", "1 → 2", "Whatever is not 0 is high."),
    *(Equivalent(
        "hdl/arithmetic/narrowing.py",
        "return Mux(value < low, Const(low, width), Mux(value > high, Const(high, width), value))"
        "[:width]", change, "Either end is what is held to it.")
      for change in ("value < low → value <= low", "value > high → value >= high")),
    Equivalent(
        "hdl/depth_test/signature.py", '"forwarded": Out(1),', "Out(1) → Out(2)", _WIDER),
    Equivalent("hdl/backplane/words.py", '"none": 1,', "1 → 2", _WIDER),
    *(Equivalent(
        "hdl/mapping/interlace.py",
        "pitch = Signal(range(max(interlace.pitch for interlace in interlaces) + 1))",
        "max((interlace.pitch for interlace in interlaces)) + 1 → "
        f"max((interlace.pitch for interlace in interlaces)) + {more}",
        "Where the largest pitch is a power of two, all are, and nobody reads it.")
      for more in (0, 2)),
    Equivalent(
        "hdl/memory_unit/memory_access.py", '"read_busy": In(1),', "In(1) → In(2)", _WIDER),
    *(Equivalent(
        "hdl/memory_unit/sweep_part.py", "COMPARED_BITS = 4", f"4 → {bits}",
        "With each bit false alarms, which cost clocks only, are half as many or twice as many.")
      for bits in (3, 5)),
    Equivalent(
        "hdl/memory_unit/one_port_memory.py",
        "m.d.comb += [address.eq(access.sweep_address), read.en.eq(access.sweep),",
        "read.en.eq(access.sweep) → *()", "A port reads unless it is told not to, and an answer is "
        "looked at by whoever has asked, in the next clock only."),
    Equivalent(
        "hdl/memory_unit/tag_sweep.py", "wraps = words == 1 << len(self.address)",
        "1 << len(self.address) → 1 >> len(self.address)",
        "The comparison tells the last word as well as the carry does."),
    Equivalent(
        "hdl/rasteriser/edge_columns.py",
        "width = Const(widths.pop()) if len(widths) == 1 else self.width",
        "len(widths) == 1 → False",
        "The line says the same number; it only costs a wire."),
    *(Equivalent(
        "hdl/rasteriser/edge_columns.py",
        "return Mux(column < 0, 0, Mux(magnitude >= width, width, magnitude))", change,
        "Either end is what is held to it.")
      for change in ("column < 0 → column <= 0", "column < 0 → column < 1",
                     "magnitude >= width → magnitude > width")),
    Equivalent(
        "hdl/processing_element/control.py", '"idle": Out(1),', "Out(1) → Out(2)", _WIDER),
    Equivalent(
        "hdl/rasteriser/edge_columns.py", "return Mux(column >= width, width, column)",
        "column >= width → column > width", "The end is what is held to it."),
    Equivalent(
        "hdl/triangle_setup/edge_setup.py",
        "self._product = PipelinedMultiplier(a_bits=position, b_bits=height + 1, pairs=2)",
        "height + 1 → height + 2", _WIDER),
    Equivalent(
        "hdl/triangle_setup/edge_setup.py",
        "self._product = PipelinedMultiplier(a_bits=position, b_bits=height + 1, pairs=2)",
        "pairs=2 → pairs=3", "The third product is 0 by 0."),
    *(Equivalent(
        "hdl/triangle_setup/outline.py",
        f'"{name}_x": signed(bits + 1), "{name}_y": bits,', "bits + 1 → bits + 2", _WIDER)
      for name in ("middle", "lower")),
    Equivalent(
        "hdl/triangle_setup/outline.py", "difference = configuration.coordinate_bits + 1",
        "configuration.coordinate_bits + 1 → configuration.coordinate_bits + 2", _WIDER),
    *(Equivalent(
        "hdl/triangle_setup/outline.py", "clockwise = area.sum >= 0", f"area.sum >= 0 → {wrong}",
        "A triangle without area is dropped, whichever way round it is.")
      for wrong in ("area.sum > 0", "area.sum >= 1")),
    Equivalent(
        "testbenches/export/verilog.py",
        "return address if len(address) == width else Cat(address, C(0, width - len(address)))",
        "len(address) == width → False", "Nothing is put before what is wide enough."),
)
