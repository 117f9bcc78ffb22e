"""What every command does with input that is wrong."""

from collections.abc import Callable
from pathlib import Path

from click.testing import Result

#: Scenes and machines that no command takes, and a word of what each says of them.
BAD_SCENES_AND_MACHINES = [
    (["teapott"], "did you mean teapot?"),
    (["nowhere.obj"], "no such file"),
    (["--cards", "PMMM"], "power of two"),
    (["--size", "16"], "width and a height"),
    (["--size", "4096x4096", "--cards", "PM"], "words"),
    (["--fraction-bits", "65"], "fraction-bits"),
    (["--preset", "huge"], "huge"),
    (["--packet", "3"], "--packet: 2x(PMM) has no merge card, and so one node"),
    (["--queue", "3", "--cards", "2x(PMC)"], "--queue: 2x(PMC) has no direct merge; leave it out"),
    (["--view", "10"], "'10' is not 2 numbers, AZIMUTH,ELEVATION"),
    (["--view", "0,91"], "elevation: 91.0 is not from -90 to 90 degrees"),
    (["--zoom", "nan"], "zoom: nan is not from 0.05 to 30.0"),
    (["--light", "0,0,0"], "light: (0.0, 0.0, 0.0) is no direction"),
    (["--background", "nix"], "'nix' is no colour; take a name such as navy"),
    (["random", "--cull"], "random: cull: its triangles are made on the screen"),
    (["hard:crossing-3-lsb", "--view", "0,0"], "view: a display list is already projected and lit"),
]


def listing() -> dict[str, bytes | None]:
    """Everything in the folder: the contents of files, None for folders."""
    return {str(path): path.read_bytes() if path.is_file() else None
            for path in Path().rglob("*")}


def refusal(run: Callable[..., Result], *arguments: object) -> str:
    """The line that ``run(*arguments)`` says: status 2, one line, nothing on the output, nothing
    new in the folder."""
    before = listing()
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert_one_line(result.stderr)
    assert listing() == before
    return result.stderr


def assert_one_line(errors: str) -> None:
    """``errors`` are one line, of an error."""
    assert errors.startswith("cardcage: error: ")
    assert errors.count("\n") == 1 and errors.endswith("\n")
    assert "Traceback" not in errors
