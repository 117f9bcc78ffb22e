"""Machines that draw more than the one list they are made for."""

from cardcage.golden.reference.triangle_setup import scene_fraction_bits
from cardcage.golden.specification.configuration import MachineConfiguration


def wide_machine(display_list, *, cards, fraction_bits=None, **fields):
    """A machine for lists like this one, with words for every triangle of the guard band.

    ``fraction_bits`` None: as many as make ``display_list`` exact at the resolution that the
    memory of the cards holds.
    """
    formats = {name: getattr(display_list, name)
               for name in ("width", "height", "sub_bits", "depth_bits")}
    fields = formats | {"shading": "flat" if display_list.flat else "gouraud"} | fields
    if fraction_bits is None:
        interlace = MachineConfiguration(cards=cards, **fields).interlace
        fraction_bits = scene_fraction_bits(display_list, x_shift=interlace.x_shift,
                                            y_shift=interlace.y_shift)
    return MachineConfiguration(cards=cards, fraction_bits=fraction_bits, **fields)
