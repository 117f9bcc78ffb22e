"""Machines that deal regions out, compiled once for all tests, and what they draw."""

import numpy as np
from frames import random_list
from wide_machines import wide_machine

#: Cards, size, regions, and the rest; of some all slots are needed.
MODELS = {
    "three, two ports": ("3x(PMM)", (33, 17), (5, 3), {"memory_ports": 2}),
    "four, full": ("4x(PM)", (32, 16), (4, 4), {"slots": 4}),
    "five, full, vertices": ("5x(PMM)", (33, 17), (5, 3), {
        "slots": 3, "setup": "hardware", "setup_interval": 40, "shading": "flat",
        "memory_ports": 2}),
    "sixteen": ("16x(PM)", (33, 17), (9, 5), {"slots": 3, "memory_ports": 2,
                                              "shading": "flat"}),
    "strips, one port": ("4x(PMM)", (33, 16), (1, 4), {"slots": 1, "balance": "static"}),
}
BALANCERS = {
    "three, two ports": ("3x(PMM)", (33, 17), (5, 3), {"memory_ports": 2}),
    "four, full, triangles": ("4x(PM)", (32, 16), (4, 4), {"slots": 4, "balance": "triangles"}),
}


def machine(models, name, **changes):
    cards, (width, height), regions, options = models[name]
    flat = options.get("shading") == "flat"
    listed = random_list(0, 4, width=width, height=height, flat=flat)
    return wide_machine(listed, cards=cards, clocks_per_pixel=2, fraction_bits=40, regions=regions,
                        **options | changes)


def some_list(configuration, seed, count):
    return random_list(seed, count, width=configuration.width, height=configuration.height,
                       flat=configuration.shading == "flat")


def random_table(pick, configuration):
    """One that fills some element's slots to the last, if not those of all."""
    elements = list(range(configuration.processing_elements))
    pick.shuffle(elements)
    places = [element for element in elements for _ in range(configuration.slots)]
    table = places[:configuration.dealt_regions.count]
    pick.shuffle(table)
    return np.array(table)
