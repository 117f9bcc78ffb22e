"""The face of the package: what ``import cardcage`` gives, and what it does not load."""

import ast
import doctest
import importlib.metadata
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import cardcage

FACE = Path(cardcage.__file__)
#: Nobody waits for these who does not use them.
HEAVY = ("amaranth", "click", "jinja2", "matplotlib", "numpy", "PIL", "trimesh")


def run(*words, **options):
    return subprocess.run([sys.executable, *words], capture_output=True, text=True, timeout=100,
                          **options)


def loaded_by(statements):
    """Those of ``HEAVY`` that a new Python has loaded after these statements."""
    done = run("-c", f"import sys; {statements}; print(*sorted(set({HEAVY}) & set(sys.modules)))")
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def checked_names():
    """Names that type checkers find: what the block under ``TYPE_CHECKING`` imports, and from
    where; and what it declares."""
    [block] = [node for node in ast.parse(FACE.read_text("utf-8")).body if isinstance(node, ast.If)]
    imports = {alias.name: node.module for node in block.body if isinstance(node, ast.ImportFrom)
               for alias in node.names}
    return imports, [node.target.id for node in block.body if isinstance(node, ast.AnnAssign)]


def test_importing_it_loads_nothing_that_takes_time():
    assert loaded_by("import cardcage") == []
    assert loaded_by("import cardcage; cardcage.__version__; dir(cardcage)") == []


def test_a_name_loads_no_more_than_it_needs():
    assert loaded_by("from cardcage import DisplayList, MachineConfiguration") == ["numpy"]
    wanted = "make_display_list, plan, render, export, compare, simulate_frame"
    assert not {"amaranth", "matplotlib"} & set(loaded_by(f"from cardcage import {wanted}"))
    assert "amaranth" in loaded_by("from cardcage import Machine")


def test_type_checkers_see_what_is_there():
    imports, declared = checked_names()
    assert imports == cardcage._HOMES
    assert sorted([*imports, *declared]) == sorted(cardcage.__all__)
    assert (FACE.parent / "py.typed").is_file()


def test_dir_names_everything():
    assert set(cardcage.__all__) <= set(dir(cardcage))


def test_the_version_is_the_installed_one():
    assert cardcage.__version__ == importlib.metadata.version("cardcage")


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'cardcage' has no attribute 'configure'"):
        _ = cardcage.configure


@pytest.mark.parametrize("name", ["the module", *(n for n in cardcage.__all__ if n[0] != "_")])
def test_its_example_does_what_it_says(name, tmp_path, monkeypatch):
    """The docstring of every public name has an example, which is run."""
    monkeypatch.chdir(tmp_path)
    it = cardcage if name == "the module" else getattr(cardcage, name)
    [example] = doctest.DocTestFinder(recurse=False).find(it, name, module=inspect.getmodule(it),
                                                          globs={})
    assert example.examples, f"{name} shows no example"
    said = []
    doctest.DocTestRunner().run(example, out=said.append)
    assert not said, "".join(said)


def test_render_reports_where_it_is_told(tmp_path):
    rendering = cardcage.render("random:n=3,size=8,seed=5", cards="PM", size=(16, 16),
                                engine="pysim", out=str(tmp_path / "report"))
    assert rendering.comparison.equal
    assert rendering.report == tmp_path / "report" / "report.html"
    assert rendering.report.is_file()


def test_an_option_that_does_not_exist_is_named():
    with pytest.raises(TypeError, match="crads"):
        cardcage.render("tetra", crads="PM")
    with pytest.raises(TypeError, match="crads"):
        cardcage.export("machine.v", crads="PM")


def test_the_module_is_the_command_line(tmp_path):
    done = run("-m", "cardcage", "--version", cwd=tmp_path)
    assert done.stdout == f"cardcage, version {cardcage.__version__}\n"
    done = run("-m", "cardcage", "render", "nowhere.obj", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("cardcage: error: nowhere.obj")
