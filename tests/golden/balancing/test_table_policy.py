"""Which tables can be made for which machine."""

from typing import get_args

import pytest

from cardcage.golden.balancing.table_policy import Policy, check_policy, counted_by, default_policy
from cardcage.golden.specification.configuration import MachineConfiguration
from cardcage.golden.specification.errors import InputError
from cardcage.golden.specification.regions import Balance


def machine(**fields):
    return MachineConfiguration("3x(PM)", 20, 14, regions=(5, 4), **fields)


@pytest.mark.parametrize(("fields", "default", "others"), [
    ({}, "learnt", {"clocks"}),
    ({"balance": "triangles"}, "triangles", set()),
    ({"balance": "static"}, "static", {"runs"}),
    ({"balancer": "hardware"}, "clocks", set()),
    ({"balance": "triangles", "balancer": "hardware"}, "triangles", set())], ids=str)
def test_what_a_machine_can_be_dealt_out_by(fields, default, others):
    configuration = machine(**fields)
    assert default_policy(configuration) == default
    for policy in get_args(Policy):
        if policy in {default} | others:
            check_policy(configuration, policy)
            assert counted_by(policy) == configuration.balance
        else:
            with pytest.raises(InputError, match=f"^balance: {policy} is for "):
                check_policy(configuration, policy)


def test_all_that_is_counted_is_a_policy():
    assert {*get_args(Balance), "learnt", "runs"} == {*get_args(Policy)}
    with pytest.raises(InputError, match="'even' is none of static, runs, triangles, clocks"):
        check_policy(machine(), "even")
