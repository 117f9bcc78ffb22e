"""Writes the report of a sequence of pictures: that of one picture, and what came of all."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, StrMethodFormatter
from PIL import Image

from ...golden.scenes.camera import View
from ..frames.rendering import Rendering
from ..sequence.sequence_run import SequenceFrame
from .frame_pictures import data_uri
from .frame_report import REPORT_FILES, report_page, write_files
from .page import chart_style, svg_element
from .region_pictures import region_picture, utilisation_chart
from .sequence_facts import sequence_facts
from .work_chart import BUSY_COLOR, FRAGMENTS_COLOR

ANIMATION = "animation.png"

#: Everything that ``write_sequence_report`` writes.
SEQUENCE_FILES = (*REPORT_FILES, ANIMATION)

#: Pictures in the strip of the page: the first and the last, and those evenly between.
STRIP_PICTURES = 12

#: Of a screen, for the animation: a picture lasts as many of its scans as it was seen on.
SCANS_A_SECOND = 60


def write_sequence_report(rendering: Rendering, frames: Sequence[SequenceFrame],
                          views: Sequence[View], folder: Path) -> None:
    """Write ``SEQUENCE_FILES`` to ``folder``, which exists; ``rendering`` is one of the frames."""
    facts = sequence_facts(rendering, frames, views)
    animation = animated_png(frames)
    (folder / ANIMATION).write_bytes(animation)
    page = report_page(
        rendering, facts, "sequence.html",
        animation=f"data:image/png;base64,{base64.b64encode(animation).decode()}",
        strip=[(frames[place].number, data_uri(frames[place].simulation.video))
               for place in strip_places(len(frames))],
        region_strip=[(frame.number, data_uri(region_picture(frame.regions,
                                                             frame.simulation.video)))
                      for frame in map(frames.__getitem__, strip_places(len(frames)))
                      if frame.regions is not None],
        utilisation_chart=(utilisation_chart(facts["frames"])
                           if rendering.regions is not None else None),
        sequence_chart=sequence_chart(facts["frames"], facts["machine"]["cycles_per_scan"]))
    write_files(rendering, folder, facts, page)


def animated_png(frames: Sequence[SequenceFrame]) -> bytes:
    """An APNG of what was on the pins; a viewer that does not know it shows the first picture."""
    first, *others = (Image.fromarray(frame.simulation.video) for frame in frames)
    file = io.BytesIO()
    first.save(file, "PNG", save_all=True, append_images=others, loop=0,
               duration=[1000 * frame.scans / SCANS_A_SECOND for frame in frames])
    return file.getvalue()


def strip_places(frames: int) -> list[int]:
    """Which pictures are in the strip."""
    shown = min(frames, STRIP_PICTURES)
    return [round(place * (frames - 1) / max(1, shown - 1)) for place in range(shown)]


def sequence_chart(frames: Sequence[dict[str, Any]], scan: int) -> str:
    """An ``<svg>`` element, over the pictures: clocks to draw each, and how evenly the processing
    elements shared the work."""
    numbers = [frame["number"] for frame in frames]
    with chart_style():
        figure = Figure(figsize=(9.0, 4.2), layout="constrained")
        clocks, share = figure.subplots(2, 1, sharex=True)
        clocks.step(numbers, [frame["draw"] for frame in frames], where="mid",
                    color=FRAGMENTS_COLOR, label="to draw")
        merged = [frame["merged"] for frame in frames]
        if merged != [frame["draw"] for frame in frames] and None not in merged:
            clocks.step(numbers, merged, where="mid", color=BUSY_COLOR, label="until merged")
        clocks.axhline(scan, linestyle=":", linewidth=1, color="#8a94a6", label="a scan")
        clocks.set_ylabel("clocks")
        clocks.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        clocks.set_ylim(bottom=0)
        clocks.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
        counted = [(frame["number"], [element["fragments"] for element in frame["per_pe"]])
                   for frame in frames if frame["per_pe"]]
        known = [number for number, _ in counted]
        share.step(known, [sum(each) / len(each) for _, each in counted], where="mid", marker=".",
                   color=FRAGMENTS_COLOR, label="of an element, mean")
        share.step(known, [max(each) for _, each in counted], where="mid", marker=".",
                   color=BUSY_COLOR, label="of the busiest")
        share.set_ylabel("fragments")
        share.yaxis.set_major_formatter(StrMethodFormatter("{x:,.0f}"))
        share.set_ylim(bottom=0)
        share.set_xlabel("picture")
        share.xaxis.set_major_locator(MaxNLocator(12, integer=True))
        share.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, frameon=False)
        for axes in (clocks, share):
            axes.spines[["top", "right"]].set_visible(False)
        return svg_element(figure, "Clocks and fragments of each picture")
