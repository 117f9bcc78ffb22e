"""The figures of regions that are dealt out, as plain numbers, lists and words."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..frames.region_figures import RegionFigures


def region_facts(figures: RegionFigures | None) -> dict[str, Any] | None:
    """What one picture's regions cost, and who drew them; None where none are dealt out."""
    if figures is None:
        return None
    regions = figures.configuration.dealt_regions
    return {
        "columns": regions.columns,
        "rows": regions.rows,
        "region_width": 1 << regions.x_bits,
        "region_height": 1 << regions.y_bits,
        "slots": figures.configuration.slots,
        "balance": figures.policy,
        "balancer": figures.configuration.balancer,
        **region_summary(figures),
        "table": figures.table.tolist(),
        "counts": figures.counts.tolist(),
        "next_table": figures.next_table.tolist(),
        "differences": figures.differences,
    }


def region_summary(figures: RegionFigures) -> dict[str, Any]:
    """In a few numbers, as there may be many pictures: what is counted, whether the machine was
    asked, and whether all it said is golden's."""
    loads = figures.loads
    return {
        "counted": figures.counted,
        "read": figures.slot_counts is not None,
        "table_read": figures.read_table is not None,
        "equal": not figures.differences,
        "utilisation": figures.utilisation,
        "busiest": figures.busiest,
        "per_pe": loads.tolist(),
        "total": int(loads.sum()),
        "greatest_region": int(figures.counts.max()),
        # By the next table.
        "moved": int(np.count_nonzero(figures.next_table != figures.table)),
    }
