"""The house and its wings: where a file may lie, and what it may import.

What breaks a rule is named, a line each.  ``golden``, ``hdl``, ``testbenches`` and ``package``
become the installed package; a *wing* is a folder in one of the first three, or a module beside
those folders.
"""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent

#: The wings of each folder, from the bottom to the top: each imports only from those before it.
WINGS = {
    "golden": (
        "specification", "organisations", "scenes", "reference", "objects", "balancing", "merging",
        "planning", "cycles", "hard_cases", "scene_argument", "scene_display_list",
        "precision"),
    "hdl": (
        "wires", "arithmetic", "backplane", "mapping", "observer", "triangle_setup", "objects",
        "rasteriser", "regions", "depth_test", "merging", "memory_unit", "processing_element",
        "lines_to_all", "balancing", "controller", "video", "nodes", "snooping", "direct",
        "forwarding", "machine", "components"),
    "testbenches": (
        "support", "machine_options", "views", "export", "engines", "frames", "sequence",
        "reports", "render", "render_frames", "comparison", "speed", "fpga", "precision", "atlas",
        "figures", "cocotb_bench", "command_line", "studies"),
    "package": ("__main__",),
}
ORDER = list(WINGS)

#: What ``hdl`` may import of ``golden``: the numbers and words that both must agree on.
SHARED_WITH_HDL = {f"golden.specification.{name}" for name in (
    "activity", "card_order", "commands", "configuration", "fields.making", "interlace", "queues",
    "ranges", "regions")}

MOST_FILES = 16
MOST_LINES = 400

#: Folders of tests that mirror no wing: whole machines, and what tests share.
TESTS_OF_THEIR_OWN = ("library", "machine")


def python_files(*folders):
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def name_of(path):
    """``hdl/machine.py`` → ``("hdl", "machine")``, a package by its folder."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return parts[:-1] if parts[-1] == "__init__" else parts


MODULES = {name_of(path): path for path in python_files(*WINGS)}


def imports(path):
    """The modules of this project that a file imports anywhere in it: (line, module) each."""
    folder = path.relative_to(ROOT).parent.parts
    if folder == ("package",):
        folder = ()  # it is the package itself: the others lie below it
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            named = [tuple(alias.name.split(".")) for alias in node.names]
            found = [name[1:] for name in named if name[0] == "cardcage"]
        elif isinstance(node, ast.ImportFrom):
            base = tuple(node.module.split(".")) if node.module else ()
            if node.level:
                base = folder[:len(folder) + 1 - node.level] + base
            elif base[0] == "cardcage":
                base = base[1:]
            else:
                continue
            below = [(*base, alias.name) for alias in node.names]
            found = [name if name in MODULES else base for name in below]
        else:
            continue
        for module in dict.fromkeys(found):
            yield node.lineno, module or ("package",)


def place(module):
    """How high up in the house a module is: its folder, its wing in there."""
    wings = WINGS[module[0]]
    if len(module) == 1:  # the folder's own __init__.py
        height = -1
    elif module[1] in wings:
        height = wings.index(module[1])
    else:  # another test names it
        height = len(wings)
    return ORDER.index(module[0]), height


def said(problems):
    return "\n".join(["", *problems])


def every_import():
    for module, path in MODULES.items():
        for line, target in imports(path):
            yield module, f"{path.relative_to(ROOT)}:{line}: imports {'.'.join(target)}", target


def test_the_order_names_every_wing_and_nothing_else():
    found = {module[:2] for module in MODULES if len(module) > 1}
    listed = {(folder, wing) for folder, wings in WINGS.items() for wing in wings}
    problems = [f"{'/'.join(wing)} needs a place in WINGS above" for wing in found - listed]
    problems += [f"{'/'.join(wing)} of WINGS is no more" for wing in listed - found]
    assert not problems, said(problems)


def test_no_import_runs_upward():
    """So none runs round in a circle between wings either."""
    problems = [f"{where}, which is higher up" for module, where, target in every_import()
                if place(target) > place(module)]
    assert not problems, said(problems)


def test_hardware_shares_with_golden_what_the_list_allows():
    used = {}
    for module, where, target in every_import():
        if module[0] == "hdl" and target[0] == "golden":
            used.setdefault(".".join(target), where)
    problems = [f"{where}, which is not in SHARED_WITH_HDL" for name, where in used.items()
                if name not in SHARED_WITH_HDL]
    assert not problems, said(problems)
    assert set(used) == SHARED_WITH_HDL, "a module of SHARED_WITH_HDL is no longer imported"


def test_only_organisations_know_where_a_pixel_lies():
    """Whoever else asks the interlace or the cards would have to learn of every organisation."""
    problems = []
    for module, path in MODULES.items():
        if module[0] not in ("golden", "testbenches") or module[1:2] in (
                ("specification",), ("organisations",)):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            asked = isinstance(node, ast.Attribute) and node.attr in ("interlace", "interlaces")
            named = isinstance(node, ast.ImportFrom) and (
                (node.module or "").endswith("interlace")
                or any(alias.name == "domains" for alias in node.names))
            if asked or named:
                problems.append(f"{path.relative_to(ROOT)}:{node.lineno}: asks the interlace or "
                                "the cards; organisation_of(configuration) knows")
    assert not problems, said(problems)


def test_only_studies_import_the_installed_package():
    """They are not installed and run from a clone; all others import relatively."""
    problems = []
    for path in python_files(*WINGS):
        study = "studies" in path.parts
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.ImportFrom):
                continue
            absolute = (node.module or "").partition(".")[0] == "cardcage"
            if absolute != study and (absolute or node.level > 1):
                problems.append(f"{path.relative_to(ROOT)}:{node.lineno}: imports "
                                + ("relatively what is outside studies" if study else
                                   f"{node.module}, the installed package"))
    assert not problems, said(problems)


@pytest.mark.parametrize("folder", [*WINGS, "tests"])
def test_no_folder_is_crowded(folder):
    folders = {path.parent for path in python_files(folder)}
    counted = {inner.relative_to(ROOT): len(list(inner.glob("*.py"))) for inner in folders}
    problems = [f"{inner} has {count} Python files, more than {MOST_FILES}"
                for inner, count in sorted(counted.items()) if count > MOST_FILES]
    assert not problems, said(problems)


def test_files_stay_short():
    counted = {path.relative_to(ROOT): path.read_text(encoding="utf-8").count("\n")
               for path in python_files(*WINGS, "tests")}
    problems = [f"{path} has {lines} lines, more than {MOST_LINES}"
                for path, lines in counted.items() if lines > MOST_LINES]
    assert not problems, said(problems)


def test_every_folder_says_what_it_is_for():
    problems = []
    for folder in sorted({path.parent for path in python_files(*WINGS)}):
        says = folder / "__init__.py"
        if not says.is_file():
            problems.append(f"{says.relative_to(ROOT)} is missing")
        elif not ast.get_docstring(ast.parse(says.read_text(encoding="utf-8"))):
            problems.append(f"{says.relative_to(ROOT)} has no docstring")
    assert not problems, said(problems)


def test_tests_mirror_the_wings():
    tests = ROOT / "tests"
    folders = {path.parent.relative_to(tests) for path in tests.rglob("*.py")}
    problems = [f"tests/{folder} mirrors no folder {folder}" for folder in sorted(folders)
                if folder.parts and folder.parts[0] not in TESTS_OF_THEIR_OWN
                and not (ROOT / folder / "__init__.py").is_file()]
    assert not problems, said(problems)
