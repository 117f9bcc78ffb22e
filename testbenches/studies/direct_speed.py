"""How fast fragments reach memory through a direct merge, with each kind of queue.

As many processing elements as memory units, of two ports, 512 by 512 pixels; lists are kept in the
elements, contiguous shares of them.  ``random_bbox16`` has its list once for each element, so that
all draw the same triangles at the same time, which is the worst for a crossbar; ``right_TL_512``
has large triangles, four for each of sixteen.  Every picture is compared with the golden one.
"""

from __future__ import annotations

import click

from cardcage.golden.planning.machine_plan import plan
from cardcage.golden.specification.configuration import Queue
from cardcage.testbenches.command_line.command_options import QUEUE, Several
from cardcage.testbenches.frames.compare import compare
from cardcage.testbenches.frames.simulation import simulate_frame
from cardcage.testbenches.speed.cases import case_lists
from cardcage.testbenches.support.text_table import TextTable

#: How often the list is repeated: 0 for once for each element.
CASES = {"random_bbox16": 0, "right_TL_512": 1}


def measured(case: str, elements: int, queue: Queue, retained: bool) -> tuple[str, ...]:
    """A row: a list drawn once."""
    display_list = case_lists(case, order="random", times=CASES[case] or elements).once
    machine = plan(display_list, cards=f"{elements}x(P)D{elements}x(M)", memory_ports=2,
                   packet="contiguous", retain=retained, queue=queue).configuration
    simulation = simulate_frame(machine, display_list)
    fragments = sum(work.fragments for work in simulation.work)
    rate = fragments / simulation.draw_cycles
    return (case, str(queue), f"{fragments:,}", f"{simulation.draw_cycles:,}", f"{rate:.2f}",
            f"{100 * rate / elements:.1f} %", f"{sum(simulation.followed):,}",
            "yes" if compare(machine, display_list, simulation).equal else "NO")


@click.command()
@click.option("--elements", type=click.IntRange(1, 16), default=16, show_default=True,
              help="A power of two; and as many units.")
@click.option("--queues", type=Several(QUEUE, "N|element,…"), default="2,3,4,element",
              show_default=True, help="As of --queue.")
@click.option("--case", "cases", type=click.Choice(list(CASES)), multiple=True,
              default=list(CASES), show_default=True)
@click.option("--immediate", is_flag=True, help="Triangles are sent one by one.")
def main(elements: int, queues: tuple[Queue, ...], cases: tuple[str, ...],
         immediate: bool) -> None:
    """Measure a direct merge.

    \b
    Examples:
      python -m testbenches.studies.direct_speed
      python -m testbenches.studies.direct_speed --elements 4 --case random_bbox16
    """
    rows = tuple(measured(case, elements, queue, not immediate)
                 for case in cases for queue in queues)
    click.echo(TextTable(
        f"{elements} elements, {elements} units of two ports, a direct merge",
        ("case", "queue", "fragments", "clocks", "fragments/clock", "of all", "followed", "equal"),
        rows).text())


if __name__ == "__main__":
    main()
