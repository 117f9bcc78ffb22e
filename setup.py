"""The folders that make up the installed package; everything else is in pyproject.toml.

The folders of this repository become packages below ``cardcage``.  Which ones there are is read
off the file system, so that a new folder cannot be forgotten in a wheel.
"""

from setuptools import find_packages, setup

FOLDERS = ("golden", "hdl", "testbenches")

#: Studies are run from a clone; their results stand in ``docs``.
NOT_INSTALLED = ("studies", "studies.*")

setup(
    packages=[
        name for folder in FOLDERS
        for name in (f"cardcage.{folder}",
                     *(f"cardcage.{folder}.{inner}"
                       for inner in find_packages(folder, exclude=NOT_INSTALLED)))
    ],
    package_dir={f"cardcage.{folder}": folder for folder in FOLDERS},
)
