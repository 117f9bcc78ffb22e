"""Of what the next picture's table is made."""

from __future__ import annotations

from typing import Literal, get_args

from ..specification.configuration import MachineConfiguration
from ..specification.errors import InputError
from ..specification.regions import Balance

#: The last picture's counts as they are, of what a machine counts; or, by a host that has a
#: machine's clocks, ``learnt_counts`` of the last three.
Policy = Literal["static", "triangles", "clocks", "learnt"]


def counted_by(policy: Policy) -> Balance:
    """What a machine must count for it."""
    return "clocks" if policy == "learnt" else policy


def default_policy(configuration: MachineConfiguration) -> Policy:
    """The best of those that need no other machine: ``learnt``, where a host has its clocks."""
    if (configuration.balance, configuration.balancer) == ("clocks", "host"):
        return "learnt"
    return configuration.balance


def check_policy(configuration: MachineConfiguration, policy: Policy) -> None:
    """``InputError`` where tables for that machine cannot be made so."""
    if policy not in get_args(Policy):
        raise InputError(f"balance: {policy!r} is none of {', '.join(get_args(Policy))}")
    if policy == "learnt" and configuration.balancer == "hardware":
        raise InputError("balance: learnt is for a host, and the hardware packs the last picture's "
                         "counts as they are; take balance clocks, or the balancer host")
    if counted_by(policy) != configuration.balance:
        raise InputError(f"balance: {policy} is for machines that count {counted_by(policy)} of "
                         f"regions, this one counts {configuration.balance}")
