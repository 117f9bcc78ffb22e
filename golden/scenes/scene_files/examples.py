"""Scene files that come with the package, by name."""

from __future__ import annotations

from pathlib import Path

EXAMPLE_FOLDER = Path(__file__).parent / "example_files"

#: What each shows, his own first.
EXAMPLES = {
    "three_cubes": "three red cubes, a sphere and stars (Blazek 1991, figure 9, as it stands)",
    "five_primitives": "a sphere, a cube, a cylinder, a cone and a pyramid",
    "thousand_spheres": "a thousand small spheres of one mesh, in random colours",
    "crystals": "octahedra from a mesh file, a sphere and stars",
    "colonnade": "columns under a roof, in perspective",
}


def example_path(name: str) -> Path:
    """The scene file of that name."""
    return EXAMPLE_FOLDER / f"{name}.scene"
