"""The main job, through the command line: a real mesh, every pixel compared."""

import json

import numpy as np
import trimesh
from click.testing import CliRunner
from PIL import Image

from cardcage.testbenches.command_line.cli import main


def render(folder, *arguments):
    done = CliRunner().invoke(main, ["render", *arguments, "--random-memory", "7",
                                     "--out", str(folder)])
    assert done.exit_code == 0, done.output
    return json.loads((folder / "report.json").read_text())


def test_the_teapot_on_four_processing_elements(tmp_path):
    report = render(tmp_path, "teapot", "--cards", "4x(PMM)", "--size", "64x64")
    assert report["equal"] is True
    assert report["pixels"]["compared"] == report["depth"]["compared"] == 4096
    assert report["pixels"]["different"] == report["depth"]["different"] == 0
    assert report["depth"]["max_error_lsb"] == report["color"]["max_error"] == 0
    assert report["fragments"] == sum(part["fragments"] for part in report["per_pe"]) > 1000

    picture = np.asarray(Image.open(tmp_path / "rtl.png").convert("RGB")).reshape(-1, 3)
    colors, counts = np.unique(picture, axis=0, return_counts=True)
    assert counts.max() > 1000, "background"
    assert len(colors) >= 4, "and at least three colours"


def test_a_mesh_of_the_user(tmp_path):
    path = tmp_path / "ball.stl"
    trimesh.creation.icosphere(subdivisions=1).export(path)
    report = render(tmp_path / "out", str(path), "--cards", "PMMPMM", "--size", "24x20")
    assert report["equal"] is True
    assert report["triangles"] == 80
    assert report["pixels"]["compared"] == report["depth"]["compared"] == 480
