"""Mutants of cages of nodes are still mutants, and one of them is really killed."""

import pytest
from click.testing import CliRunner

from testbenches.studies.mutation_campaign import ROOT
from testbenches.studies.node_mutants import THOUGHTS, main


@pytest.mark.parametrize("thought", THOUGHTS, ids=lambda thought: thought.what)
def test_its_text_and_its_test_are_there(thought):
    source = (ROOT / thought.file).read_bytes()
    wrong = thought.mutant(ROOT).of(source).decode()
    assert wrong == source.decode().replace(thought.right, thought.wrong) != source.decode()
    compile(wrong, thought.file, "exec")
    file, _, function = thought.test.partition("::")
    assert f"def {function or 'test_'}" in (ROOT / file).read_text(encoding="utf-8")


def test_a_mutant_that_is_killed():
    done = CliRunner().invoke(main, ["the order is not looked at"])
    assert done.exit_code == 0, done.output
    assert "killed" in done.output and "test_chain_merge.py::test_ties" in done.output
