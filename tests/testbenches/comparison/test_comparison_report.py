"""The page, the figures for programs and the text of a comparison."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from cardcage.golden.objects.made import Made
from cardcage.golden.objects.making import LinkWords
from cardcage.golden.reference.exact import draw
from cardcage.golden.scene_display_list import make_display_list
from cardcage.testbenches.comparison.comparison_facts import comparison_facts
from cardcage.testbenches.comparison.comparison_report import COMPARISON_FILES, comparison_page
from cardcage.testbenches.comparison.comparison_table import (
    OF_OBJECTS,
    comparison_table,
    comparison_text,
    figures,
)
from cardcage.testbenches.engines.engine import Scan
from cardcage.testbenches.frames.object_figures import ObjectFigures

LIST = make_display_list("random:n=12,size=5,seed=5", width=8, height=8,
                         shading="flat").display_list


def page(comparison):
    return comparison_page(comparison, comparison_facts(comparison))


def test_files(small, tmp_path):
    comparison = small(out=tmp_path / "out", command_line="cardcage compare <&>")
    folder = tmp_path / "out"
    assert comparison.report == folder / "comparison.html"
    assert sorted(path.name for path in folder.iterdir()) == sorted(COMPARISON_FILES)
    with Image.open(folder / "comparison.png") as picture:
        np.testing.assert_array_equal(np.asarray(picture), draw(LIST).color)
    facts = json.loads((folder / "comparison.json").read_text("utf-8"))
    assert facts == json.loads(json.dumps(comparison_facts(comparison)))
    text = (folder / "comparison.html").read_text("utf-8")
    assert text.count("data:image/png") == 1 and "the picture, identical on all" in text
    assert "cardcage compare &lt;&amp;&gt;" in text
    assert not re.search(r"""(src|href)=["'](?!data:|#)|https?://|url\((?!#)""", text)


def test_figures_for_programs(small):
    facts = comparison_facts(small(nodes=(1, 2), simulate=0))
    assert facts["identical"] and facts["equal"] and facts["differences"] == []
    assert facts["pictures"] == [[cage["label"] for cage in facts["cages"]]]
    assert facts["triangles"] == 12 and facts["refused"] == []
    for cage in facts["cages"]:
        cycles, traffic = cage["cycles"], cage["traffic"]
        assert cycles["frame"] % cycles["scan"] == 0
        assert (cycles["load"] is None) == (not cage["retained"])
        assert cage["latency"]["pins"] > cage["latency"]["merged"] >= cycles["merge"]
        assert sum(node["fragments"] for node in cage["nodes"]) == cage["fragments"]
        assert traffic["bits"] == traffic["pixels"] * traffic["pixel_bits"]
        assert traffic["busiest_link"]["pixels"] == max(traffic["links"], default=0)
        assert cage["memory"]["bits"] == sum(
            memory["words"] * memory["bits"] * memory["instances"]
            for memory in cage["memory"]["memories"])
        assert cage["machine"]["nodes"] == len(cage["nodes"]) == (1 if "PM)" in cage["cards"]
                                                                  else 2)
    organisations = [cage["machine"]["organisation"] for cage in facts["cages"]]
    assert len(set(organisations)) == 3
    assert len(facts["sweep"]) == 10  # five kinds, the scene as it is and one that grows
    for curve in facts["sweep"]:
        assert [point["nodes"] for point in curve["points"]] == [1, 2]
        assert curve["points"][0]["model"]["speed_up"] == 1
        assert (curve["points"][1]["simulated"] is None) == curve["growing"]


def test_the_page_of_a_sweep(small):
    text = page(small(nodes=(1, 2, 4), simulate=0))
    assert len(re.findall("<svg", text)) == 2
    assert "More nodes" in text and "a scene that grows with the machine" in text
    assert "PMC, retained" in text and "PM, one node" in text


def test_what_differs_is_seen(tampered):
    def darker(run):
        return {"scans": [Scan(scan.cycle, scan.picture // 2) for scan in run.scans]}

    comparison = tampered("PMTPMT", darker, retain=False)
    text = page(comparison)
    assert "verdict different" in text and "<h1>DIFFERENT: 2x(PMT): " in text
    assert text.count("data:image/png") == 2
    assert "2x(PMT): grey equal, red different" in text and "identical on all" not in text
    assert comparison_text(comparison).startswith("DIFFERENT: 2x(PMT): ")


def test_one_cage_and_none(small, tampered):
    alone = small(("2x(PM)",))
    assert "identical on the one cage" in comparison_text(alone)
    assert "sent between nodes" in page(alone)

    def hang(run):
        raise TimeoutError("no end after 9 cycles")

    nothing = tampered("PMPM", hang, cards=("2x(PM)",))
    assert nothing.runs == [] and not nothing.identical
    assert "no end after 9 cycles" in page(nothing)
    assert comparison_text(nothing).splitlines() == [
        "DIFFERENT: 2x(PM): the machine failed: no end after 9 cycles",
        "random:n=12,size=5,seed=5: 12 triangles at 8x8"]


def test_text_is_aligned(small, capsys):
    comparison = small(nodes=(1, 2), simulate=0)
    verdict, scene, _, title, header, *lines = comparison_text(comparison).splitlines()
    assert verdict == ("identical on all 5 cages: 64 colours and 64 depths, all fragments, all "
                       "pixels sent")
    assert scene == "random:n=12,size=5,seed=5: 12 triangles at 8x8" and title == "the cages"
    assert header.endswith("2x(PM)  2x(PMC)  2x(PMC) retained  2x(PMT)  2x(PMT) retained")
    draw_line = next(line for line in lines if line.startswith("  draw"))
    assert draw_line.split()[1:] == [f"{run.clocks.draw:,}" for run in comparison.runs]
    assert len(draw_line) == len(header)
    assert lines[0] == "clocks"
    comparison_table(comparison)
    assert "speed-up, the scene as it is" in capsys.readouterr().out


def test_what_was_made_of_objects_only_where_some_cage_makes_it(small):
    comparison = small(nodes=(1, 2), simulate=0)
    assert OF_OBJECTS not in figures(comparison) and "Triangles made" not in page(comparison)
    words = LinkWords(70, 12)
    made = ObjectFigures(
        replace(comparison.runs[1].configuration, setup="hardware", objects="nodes", meshes=1,
                mesh_triangles=12),
        objects=3, clipped=0, meshes=1, mesh_triangles=12,
        golden=[Made(2, 1024, 0, 5), Made(1, 512, 0, 7)], made=[1024, 512], dropped=[5, 7],
        forwarded=None, golden_forwarded=[], words=words, golden_words=words, triangle_words=400)
    first, second, *others = comparison.runs
    comparison = replace(comparison, runs=[first, replace(second, objects=made), *others])
    rows = dict(figures(comparison)[OF_OBJECTS])
    assert rows["triangles made"] == ["-", "1,536", "-", "-", "-"]
    assert rows["triangles dropped in set-up"] == ["-", "12", "-", "-", "-"]
    text = page(comparison)
    assert "<td>triangles made</td>" in text and "<dt>Triangles made" in text
    facts = comparison_facts(comparison)["cages"][1]["objects"]
    assert (facts["made"], facts["dropped"]) == (1536, 12)


@pytest.mark.parametrize("name", ["cells", "gates"])
def test_cells_only_where_they_were_counted(small, name):
    assert name not in comparison_text(small())
