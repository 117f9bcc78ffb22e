"""The campaign on a toy project: what its tests see, what they overlook, what cannot be seen."""

import json
from collections import Counter

import pytest
from click.testing import CliRunner

from testbenches.studies import mutation_campaign
from testbenches.studies.mutation.campaign_trial import Outcome, own_tests
from testbenches.studies.mutation.equivalent_mutants import EQUIVALENT, Equivalent
from testbenches.studies.mutation.mutants import mutants_of
from testbenches.studies.mutation_campaign import (
    KILLED,
    ROOT,
    SAME,
    SURVIVED,
    Results,
    main,
    report,
    run_campaign,
    sample,
)

TOY = '''"""The larger of two, and a sum."""


def larger(a: int, b: int) -> int:
    """Not 1 < 2."""
    if a > b:
        return a
    return b


def total(numbers):
    so_far = 0
    while numbers:
        so_far, numbers = so_far + numbers[0], numbers[1:]
    return so_far
'''
TESTS = """from cardcage.hdl.toy.numbers import larger, total


def test_larger():
    assert larger(1, 2) == 2


def test_total():
    assert total([1, 2, 4]) == 7
"""
TIE = Equivalent("hdl/toy/numbers.py", "if a > b:", "a > b → a >= b", "Both are equal then.")
FILE = TIE.file


@pytest.fixture
def toy(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # they take longer than the tests
    root = tmp_path / "toy"
    for name, text in {
        "package/__init__.py": "", "hdl/__init__.py": "", "hdl/toy/__init__.py": "", FILE: TOY,
        "tests/hdl/toy/test_numbers.py": TESTS,
        "pyproject.toml": "[tool.pytest.ini_options]\n",
    }.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def changes(root, file=FILE):
    return [mutant.change for mutant in mutants_of(root, file)]


def test_the_mutants_of_a_file(toy):
    """Each differs in one place; none in what is for people only."""
    assert Counter(changes(toy)) == Counter([
        "a > b → True", "a > b → False", "a > b → a >= b", "0 → 1",
        "so_far + numbers[0] → so_far - numbers[0]", "numbers[0] → numbers[1]", "1: → 2:",
        "1: → 0:"])
    for mutant in mutants_of(toy, FILE):
        wrong = mutant.of(TOY.encode()).decode()
        different = [place for place, (one, other) in enumerate(
            zip(TOY.splitlines(), wrong.splitlines(), strict=True), 1) if one != other]
        assert different == [mutant.line]
        assert mutant.text == TOY.splitlines()[mutant.line - 1].strip()


@pytest.mark.parametrize(("line", "wanted"), [
    ("m.d.comb += [a.eq(b), c.eq(~d)]", ["a.eq(b) → *()", "c.eq(~d) → *()", "~d → d"]),
    ("m.d.sync += a.eq(b)", ["a.eq(b) → []"]),
    ("with m.If(a): pass", ["a → 1", "a → 0"]),
    ("x = Mux(a, b, c)", ["Mux(a, b, c) → Mux(a, c, b)"]),
    ("x = Signal(reset_less=True), dataclass(frozen=True)", []),
    ("x = Signal(reset_less=False)", ["reset_less=False → reset_less=True"]),
    ("x = a if b else c", ["b → True", "b → False"]),
    ("x = 1 <= a < b", ["1 <= a < b → 1 < a < b", "1 <= a < b → 1 <= a <= b",
                        "1 <= a < b → 2 <= a < b", "1 <= a < b → 0 <= a < b"]),
    ("x = a and not b", ["a and (not b) → a or not b", "not b → b"]),
    ("x = max(a) | y.any()", ["max(a) | y.any() → max(a) & y.any()", "max(a) → min(a)",
                              "y.any() → y.all()"]),
    ("x: C[1] = a << b", ["a << b → a >> b"]),
    ('raise ValueError(f"{1 + 2}")', []),
])
def test_what_is_changed_to_what(tmp_path, line, wanted):
    (tmp_path / "a.py").write_text(line + "\n")
    assert sorted(changes(tmp_path, "a.py")) == sorted(wanted)


def test_letters_of_several_bytes_before_the_place(tmp_path):
    source = 'x = "×", 1 + a\n'.encode()
    (tmp_path / "a.py").write_bytes(source)
    [mutant] = [mutant for mutant in mutants_of(tmp_path, "a.py") if "-" in mutant.change]
    assert mutant.of(source).decode() == 'x = "×", (1 - a)\n'


def test_a_sample_is_made_by_its_seed(toy):
    everything = sample(toy, ["hdl"], 100, 1)
    assert len(everything) == 8
    assert sample(toy, ["hdl"], 100, 1) == everything == sample(toy, [FILE], 100, 1)
    assert sample(toy, ["hdl"], 3, 1) == everything[:3]
    assert sample(toy, ["hdl"], 100, 2) != everything
    # Another line above leaves the draw as it is.
    (toy / FILE).write_text("# A comment.\n" + TOY)
    moved = sample(toy, ["hdl"], 100, 1)
    assert [mutant.key for mutant in moved] == [mutant.key for mutant in everything]
    assert [mutant.line for mutant in moved] == [mutant.line + 1 for mutant in everything]


def test_killed_survived_and_equivalent_are_told_apart(toy, tmp_path):
    wanted = {"a > b → False": SURVIVED, "a > b → a >= b": SAME, "0 → 1": KILLED, "1: → 0:": KILLED}
    mutants = [mutant for mutant in sample(toy, ["hdl"], 100, 1) if mutant.change in wanted]
    results = Results.read(tmp_path / "kept.json")
    run_campaign(toy, mutants, results, known=[TIE], jobs=2, patience=3.0)
    assert {mutant.change: results.verdict(mutant, [TIE]) for mutant in mutants} == wanted
    told = {mutant.change: results.verdicts[mutant.key][1] for mutant in mutants
            if mutant.key in results.verdicts}
    assert told == {"a > b → False": "", "1: → 0:": "no end in time",
                    "0 → 1": "tests/hdl/toy/test_numbers.py::test_total"}
    said = report(mutants, results, [TIE]).splitlines()
    assert said[0] == "4 mutants" and said[1].split() == ["file", KILLED, SURVIVED, SAME]
    assert said[2].split() == [FILE, "2", "1", "1"]
    assert said[3].split() == ["all", "2", "1", "1"]
    assert said[4:] == [f"{FILE}:6: survived: a > b → False"]
    # The project itself is as it was, and what is kept says the same to the next campaign.
    assert (toy / FILE).read_text() == TOY
    assert report(mutants, Results.read(tmp_path / "kept.json"), [TIE]).splitlines() == said


def test_what_has_a_verdict_is_not_run_again(toy, tmp_path, monkeypatch):
    run = []
    monkeypatch.setattr(mutation_campaign, "_trial", lambda copy, mutant, *_: (
        run.append(mutant.change), Outcome(len(run) == 2))[1])
    monkeypatch.setattr(mutation_campaign, "ROOT", toy)
    kept = tmp_path / "kept.json"

    def campaign(count, *options):
        run.clear()
        return CliRunner().invoke(main, ["--sample", str(count), "--folder", "hdl", "--resume",
                                         str(kept), *options])
    assert campaign(3).exit_code == 1  # one survived
    first = list(run)
    assert len(first) == 3 and len(json.loads(kept.read_text())["verdicts"]) == 3
    assert campaign(3).exit_code == 1 and run == []
    again = campaign(3, "--again")
    assert again.exit_code == 0 and run == first[1:2], again.output
    assert campaign(5).exit_code == 1 and len(run) == 2 and not {*run} & {*first}


def test_what_kills_passes_without_a_mutant(toy):
    test = toy / "tests/hdl/toy/test_numbers.py"
    test.write_text(TESTS + "\n\ndef test_wrong():\n    assert False\n")
    [mutant] = [mutant for mutant in mutants_of(toy, FILE) if mutant.change == "a > b → False"]
    with pytest.raises(RuntimeError, match="test_wrong: fails without a mutant"):
        run_campaign(toy, [mutant], Results.read(None))


@pytest.mark.parametrize(("file", "tests"), [
    ("hdl/toy/numbers.py", ["tests/hdl/toy/test_numbers.py"]),
    ("hdl/toy/letters.py", ["tests/hdl/toy", "tests/hdl/words/test_words.py"]),
    ("hdl/toy/other/digits.py", ["tests/hdl/toy"]),
    ("hdl/letters.py", ["tests/hdl/words/test_letters.py"]),
    ("hdl/digits.py", ["tests/hdl"]),
])
def test_the_tests_of_a_file(toy, file, tests):
    """Those of its name; those of its folder and those that import it; those of a folder above."""
    words = toy / "tests/hdl/words"
    words.mkdir()
    (words / "test_words.py").write_text("import cardcage.hdl.toy.letters\n")
    (words / "test_letters.py").write_text("from cardcage.hdl.letters import a\n")
    assert own_tests(toy, file) == tests


def test_what_is_said_to_be_equivalent_is_a_mutant():
    """A line that has changed since has to be thought about again."""
    found = {file: {(mutant.text, mutant.change) for mutant in mutants_of(ROOT, file)}
             for file in {same.file for same in EQUIVALENT}}
    lost = [same for same in EQUIVALENT if (same.text, same.change) not in found[same.file]]
    assert not lost


def test_only_folders_that_there_are():
    done = CliRunner().invoke(main, ["--folder", "hdl/vidio"])
    assert done.exit_code == 2 and "there is no hdl/vidio in" in done.stderr
