"""What nodes send to merge their pictures in a tree, and what binary swap would have them send.

By the golden models: binary swap is in no machine here, since its nodes would send both ways over
the same pieces of the backplane.
"""

from __future__ import annotations

import click

from cardcage.golden.merging.binary_swap import merge_binary_swap
from cardcage.golden.merging.node_picture import node_pictures
from cardcage.golden.merging.tree import merge_tree
from cardcage.golden.organisations.shares import Shares
from cardcage.testbenches.command_line.command_options import PACKET
from cardcage.testbenches.speed.cases import case_lists
from cardcage.testbenches.support.text_table import TextTable

MERGES = {"tree": merge_tree, "binary swap": merge_binary_swap}


def table(case: str, nodes: int, packet: int | str, times: int) -> TextTable:
    display_list = case_lists(case, times=times).once
    shares = Shares(nodes, display_list.triangles, packet)  # type: ignore[arg-type]
    pictures = node_pictures(display_list, shares)
    rows = []
    for name, merge in MERGES.items():
        _, traffic = merge(pictures)
        rows.append((name, f"{sum(traffic.steps):,}", f"{traffic.busiest_piece:,}",
                     f"{traffic.pixels:,}", " ".join(f"{pixels:,}" for pixels in traffic.steps)))
    return TextTable(
        f"{case}, {display_list.triangles:,} triangles, {nodes} nodes, packet {packet}",
        ("pixels", "longest sends", "busiest piece", "in all", "longest send of each step"),
        tuple(rows))


@click.command()
@click.option("--case", default="mesh", show_default=True)
@click.option("--nodes", type=click.IntRange(1, 64), default=16, show_default=True)
@click.option("--packet", type=PACKET, default="1", show_default=True)
@click.option("--times", type=click.IntRange(1), default=1, show_default=True,
              help="How often a peers' list is repeated.")
def main(case: str, nodes: int, packet: int | str, times: int) -> None:
    """Count the pixels that nodes send.

    \b
    Examples:
      python -m testbenches.studies.merge_traffic
      python -m testbenches.studies.merge_traffic --case random_bbox16 --times 16 --nodes 8
    """
    click.echo(table(case, nodes, packet, times).text())


if __name__ == "__main__":
    main()
