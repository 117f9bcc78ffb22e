"""The folders that make up the installed package; everything else is in pyproject.toml.

The folder ``package`` becomes the package ``cardcage``, the other folders packages below it.
(A folder ``cardcage`` here would hide the installed package from whoever works in this one.)
Which ones there are is read off the file system, so that a new folder cannot be forgotten in a
wheel.
"""

from setuptools import find_packages, setup

WINGS = ("golden", "hdl", "testbenches")

#: Studies are run from a clone; their results stand in ``docs``.
NOT_INSTALLED = ("studies", "studies.*")

folders = {"cardcage": "package"} | {f"cardcage.{wing}": wing for wing in WINGS}
setup(
    packages=[name for package, folder in folders.items() for name in (
        package, *(f"{package}.{inner}"
                   for inner in find_packages(folder, exclude=NOT_INSTALLED)))],
    package_dir=folders,
)
