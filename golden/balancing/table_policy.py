"""Of what the next picture's table is made."""

from __future__ import annotations

from typing import Literal, get_args

from ..organisations.dealt_regions import DealtRegions
from ..organisations.organisation_of import organisation_of
from ..organisations.region_table import Int64, runs_table
from ..specification.configuration import MachineConfiguration
from ..specification.errors import InputError
from ..specification.regions import Balance

#: Nothing: the table is that of the boot, ``static``, or has a run of regions for each processing
#: element, ``runs``.  Or the last picture's counts as they are, of what a machine counts; or, by a
#: host that has a machine's clocks, ``learnt_counts`` of the last three.
Policy = Literal["static", "runs", "triangles", "clocks", "learnt"]

#: Those that keep the first table.
UNCOUNTED_POLICIES: tuple[Policy, ...] = ("static", "runs")


def counted_by(policy: Policy) -> Balance:
    """What a machine must count for it."""
    if policy == "learnt":
        return "clocks"
    return "static" if policy == "runs" else policy


def first_table(configuration: MachineConfiguration, policy: Policy) -> Int64:
    """int64 (regions,): by which the first picture is drawn; but for runs that with which the
    machine begins."""
    if policy == "runs":
        return runs_table(configuration.dealt_regions.count, configuration.processing_elements)
    return boot_table(configuration)


def boot_table(configuration: MachineConfiguration) -> Int64:
    """int64 (regions,): with which a machine begins, whatever a host says later."""
    organisation = organisation_of(configuration)
    assert isinstance(organisation, DealtRegions)
    return organisation.table.copy()


def default_policy(configuration: MachineConfiguration) -> Policy:
    """The best of those that need no other machine: ``learnt``, where a host has its clocks; and
    what a machine has whose processing elements pass objects on."""
    if (configuration.balance, configuration.balancer) == ("clocks", "host"):
        return "learnt"
    if configuration.forwards_objects:
        return "runs"
    return configuration.balance


def check_policy(configuration: MachineConfiguration, policy: Policy) -> None:
    """``InputError`` where tables for that machine cannot be made so."""
    if policy not in get_args(Policy):
        raise InputError(f"balance: {policy!r} is none of {', '.join(get_args(Policy))}")
    if policy == "learnt" and configuration.balancer == "hardware":
        raise InputError("balance: learnt is for a host, and the hardware packs the last picture's "
                         "counts as they are; take balance clocks, or the balancer host")
    if configuration.forwards_objects and policy != "runs":
        raise InputError(f"balance: processing elements that pass objects on have a run of regions "
                         f"each, not {policy}; take runs, or leave it out")
    if counted_by(policy) != configuration.balance:
        raise InputError(f"balance: {policy} is for machines that count {counted_by(policy)} of "
                         f"regions, this one counts {configuration.balance}")
