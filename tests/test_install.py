"""What is built holds what it should, and works wherever it is installed.

Everything is built from a copy of the sources, without a network: the dependencies of each new
environment are links to those of this one.
"""

import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

import cardcage

ROOT = Path(__file__).parent.parent
#: The folders of the package, by the name that each has when it is installed.
INSTALLED = {"package": "cardcage", "golden": "cardcage/golden", "hdl": "cardcage/hdl",
             "testbenches": "cardcage/testbenches"}
NOT_SOURCES = shutil.ignore_patterns("__pycache__", ".hypothesis")
DATA = (".cpp", ".css", ".html", ".json", ".typed", ".vlt")


def run(*words, cwd=None):
    done = subprocess.run([str(word) for word in words], cwd=cwd, capture_output=True, text=True,
                          timeout=300)
    assert done.returncode == 0, f"{words}:\n{done.stdout}{done.stderr}"
    return done.stdout


def pip(*words, cwd=None):
    return run(sys.executable, "-m", "pip", "--disable-pip-version-check", *words, cwd=cwd)


@pytest.fixture(scope="session")
def sources(tmp_path_factory):
    """A copy of everything that belongs to the project."""
    copy = tmp_path_factory.mktemp("sources")
    for folder in (".ci", "docs", "tests", *INSTALLED):
        shutil.copytree(ROOT / folder, copy / folder, ignore=NOT_SOURCES)
    for path in (*ROOT.glob("*.md"), *(ROOT / name for name in (
            "LICENSE", "MANIFEST.in", "pyproject.toml", "setup.py"))):
        shutil.copy(path, copy / path.name)
    return copy


@pytest.fixture(scope="session")
def sdist(sources, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sdist")
    run(sys.executable, "-c", "import sys; from setuptools.build_meta import build_sdist; "
        "build_sdist(sys.argv[1])", folder, cwd=sources)
    [archive] = folder.iterdir()
    return archive


@pytest.fixture(scope="session")
def wheel(sources, tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    pip("wheel", "--no-deps", "--no-index", "--no-build-isolation", "-w", folder, sources)
    [archive] = folder.iterdir()
    return archive


@pytest.fixture(scope="session")
def dependencies(tmp_path_factory):
    """A folder of links to all that is installed here but for the project itself.

    A folder on the path is not enough: the project that is installed there would be found.
    """
    links = tmp_path_factory.mktemp("dependencies")
    for folder in map(Path, sys.path):
        if folder.name not in ("site-packages", "dist-packages") or not folder.is_dir():
            continue
        for entry in folder.iterdir():
            own = entry.name.startswith(("cardcage", "__editable__", "__pycache__"))
            if not own and entry.suffix != ".pth" and not (links / entry.name).exists():
                (links / entry.name).symlink_to(entry)
    return links


def files_of(sources, folders):
    return {path.relative_to(sources).as_posix()
            for folder in folders for path in (sources / folder).rglob("*") if path.is_file()}


def test_the_wheel_holds_the_package_and_its_data_and_no_studies(sources, wheel):
    wanted = set()
    for folder, name in INSTALLED.items():
        wanted |= {name + path.removeprefix(folder) for path in files_of(sources, [folder])
                   if not path.startswith("testbenches/studies/")}
    held = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    assert held == wanted
    for ending in DATA:
        assert any(name.endswith(ending) for name in held), f"no {ending} in the package"


def test_the_source_distribution_holds_every_file(sources, sdist):
    with tarfile.open(sdist) as archive:
        held = {member.name.partition("/")[2] for member in archive if member.isfile()}
    wanted = files_of(sources, [".ci", "docs", "tests", *INSTALLED]) | {
        path.name for path in sources.iterdir() if path.is_file()}
    assert wanted <= held, wanted - held
    more = {name for name in held - wanted if not name.startswith("cardcage.egg-info/")}
    assert more <= {"PKG-INFO", "setup.cfg"}


@pytest.mark.parametrize("kind", ["wheel", "sdist", "editable"])
def test_it_works_where_it_is_installed(kind, request, sources, dependencies, tmp_path):
    place = tmp_path / "environment"
    venv.create(place, symlinks=True)
    [site_packages] = place.glob("lib/python*/site-packages")
    (site_packages / "dependencies.pth").write_text(f"{dependencies}\n", encoding="utf-8")
    python, command = place / "bin" / "python", place / "bin" / "cardcage"
    what = ["-e", sources] if kind == "editable" else [request.getfixturevalue(kind)]
    pip("--python", python, "install", "--no-deps", "--no-index", "--no-build-isolation", *what)

    found, version = run(python, "-c", "import cardcage; print(cardcage.__file__); "
                         "print(cardcage.__version__)", cwd=tmp_path).splitlines()
    home = sources / "package" if kind == "editable" else site_packages / "cardcage"
    assert Path(found) == home / "__init__.py"
    assert version == cardcage.__version__
    assert run(command, "--version", cwd=tmp_path) == f"cardcage, version {version}\n"
    drawn = run(python, "-m", "cardcage", "render", "random:n=2,size=6,seed=1", "--cards", "PM",
                "--size", "8x8", "--engine", "pysim", "--out", "drawn", cwd=tmp_path)
    assert drawn.startswith("equal")
    assert (tmp_path / "drawn" / "report.html").is_file()
