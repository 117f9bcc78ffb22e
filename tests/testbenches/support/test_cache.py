"""What is kept, whether it is still what was kept, and what is removed."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from pathlib import Path

import pytest
from click.testing import CliRunner
from refusals import assert_one_line

from cardcage.golden.specification.errors import InputError
from cardcage.testbenches.command_line.cli import main
from cardcage.testbenches.support import cache, measurement_cache

KEY = "0123456789abcdef" * 2
OTHER = "f" * 32


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """The cache's folder, which is not there yet."""
    named = tmp_path / "cache"
    monkeypatch.setenv(cache.ENVIRONMENT_VARIABLE, str(named))
    return named


@pytest.fixture
def temporary(tmp_path, monkeypatch) -> Path:
    """An empty folder for temporary files."""
    named = tmp_path / "temporary"
    named.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(named))
    return named


def model(folder: Path) -> None:
    (folder / "machine").write_bytes(bytes(1000))
    (folder / "machine").chmod(0o755)
    (folder / "notes").mkdir()
    (folder / "notes/machine.v").write_text("module machine;\n")


def command(*arguments):
    return CliRunner().invoke(main, ["cache", *arguments])


# Only what is ours


def strangers(folder: Path) -> dict[str, bytes]:
    """What others may have put into the folder that CARDCAGE_CACHE names."""
    outside = folder.parent / "outside"
    outside.mkdir()
    (outside / "photo").write_text("dear")
    (folder / "thesis.txt").write_text("thesis")
    (folder / "letters").mkdir()
    (folder / "letters" / KEY).write_text("named like a key, inside")
    (folder / ("a" * 32)).write_text("a file, not a folder")
    (folder / ("A" * 32)).mkdir()
    (folder / ("b" * 31)).mkdir()
    (folder / ("b" * 33)).mkdir()
    (folder / f".{'b' * 31}.x").mkdir()
    (folder / ".hidden").write_text("hidden")
    (folder / ("c" * 32)).symlink_to(outside)
    return everything(folder.parent)


def everything(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b""
            for path in sorted(folder.rglob("*"))}


def test_what_others_put_there_is_neither_counted_nor_removed(folder):
    folder.mkdir()
    before = strangers(folder)
    assert "0.0 MB" in command().output
    cache.cached(KEY, lambda made: (made / "model").write_bytes(bytes(3_000_000)))
    (folder / f".{OTHER}.abc123").mkdir()  # what a build left that was ended by force
    (folder / f".{OTHER}.abc123" / "half").write_bytes(bytes(2_000_000))
    assert command().output == f"5.0 MB in {folder}\n"
    cleared = command("--clear")
    assert (cleared.exit_code, cleared.output) == (0, f"5.0 MB removed from {folder}\n")
    assert everything(folder.parent) == before


def test_a_folder_that_was_there_stays(folder):
    folder.mkdir()
    cache.cached(KEY, model)
    assert command("--clear").exit_code == 0
    assert not list(folder.iterdir())


def test_a_folder_that_was_made_goes_but_not_with_a_strangers_file_in_it(folder):
    cache.cached(KEY, model)
    assert command("--clear").exit_code == 0
    assert not folder.exists()
    cache.cached(KEY, model)
    (folder / "thesis.txt").write_text("thesis")
    assert command("--clear").exit_code == 0
    assert (folder / "thesis.txt").read_text() == "thesis"
    assert cache.lookup(KEY) is None


def test_nothing_to_clear(folder):
    assert command("--clear").output.startswith("0.0 MB removed")
    folder.write_text("a file")
    assert command("--clear").exit_code == command().exit_code == 0
    assert folder.read_text() == "a file"


def test_what_cannot_be_removed_is_said(folder, monkeypatch):
    cache.cached(KEY, model)

    def refused(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(cache.shutil, "rmtree", refused)
    result = command("--clear")
    assert result.exit_code == 2
    assert_one_line(result.stderr)
    assert KEY in result.stderr and "Permission denied" in result.stderr


# What is not sound any more


@pytest.mark.parametrize("damage", [
    lambda made: (made / "machine").write_bytes(bytes(999)),
    lambda made: (made / "machine").write_bytes(b""),
    lambda made: (made / "machine").write_bytes(bytes(999) + b"\1"),
    lambda made: (made / "machine").unlink(),
    lambda made: (made / "machine").chmod(0o644),
    lambda made: (made / "notes/machine.v").unlink(),
    lambda made: (made / "notes/machine.v").rename(made / "notes/other.v"),
    lambda made: (made / "checksum").unlink(),
    lambda made: (made / "checksum").write_bytes(b"\xff"),
    lambda made: shutil.rmtree(made) or made.mkdir(),
    lambda made: shutil.rmtree(made) or made.write_text("a file"),
], ids=range(11))
def test_what_is_damaged_is_built_anew_once(folder, damage):
    made, fresh = cache.cached(KEY, model)
    whole = everything(made)
    assert fresh and cache.cached(KEY, model) == (made, False)
    damage(made)
    assert cache.cached(KEY, model) == (made, True)
    assert everything(made) == whole and os.access(made / "machine", os.X_OK)
    assert cache.cached(KEY, model) == (made, False)
    assert {path.name for path in folder.iterdir()} == {KEY, "CACHEDIR.TAG"}


@pytest.mark.parametrize("text", ['{"value": 2', '{"value": 3}', "[]", ""])
def test_a_damaged_measurement_is_measured_again(folder, text):
    def measured(value):
        return measurement_cache.measured_once(["a", "b"], lambda: {"value": value})

    assert measured(2) == measured(3) == {"value": 2}
    [file] = folder.glob("*/measurement.json")
    file.write_text(text)
    assert measured(4) == measured(5) == {"value": 4}


# Where there is no room


def test_a_full_cache_is_replaced(folder, temporary):
    def build(made):
        if folder in made.parents:
            raise OSError(28, "No space left on device")
        model(made)

    made, fresh = cache.cached(KEY, build)
    assert fresh and (made / "machine").exists() and made.parent == temporary
    assert [path.name for path in folder.iterdir()] == ["CACHEDIR.TAG"]
    cache._temporary.pop().cleanup()  # as at the program's end


def test_no_room_anywhere(folder, temporary):
    def build(made):
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space left"):
        cache.cached(KEY, build)
    cache._temporary.pop().cleanup()
    assert not list(temporary.iterdir())


def test_a_measurement_that_cannot_be_kept_leaves_nothing(folder, temporary):
    folder.write_text("a file")
    assert measurement_cache.measured_once(["a"], lambda: {"value": 1}) == {"value": 1}
    assert measurement_cache.recall(["a"]) is None
    assert not list(temporary.iterdir())


def test_a_relative_name_is_meant_from_here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(cache.ENVIRONMENT_VARIABLE, "here")
    assert cache.cache_folder() == tmp_path / "here"


def test_a_damaged_model_that_cannot_be_moved_leaves_no_folders(folder, temporary, monkeypatch):
    """As where it is another user's: the model is then a temporary one, each time."""
    made, _ = cache.cached(KEY, model)
    (made / "checksum").unlink()
    rename = Path.rename

    def refuses(path, target):
        if path == made:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", refuses)
    for _ in range(2):
        elsewhere, fresh = cache.cached(KEY, model)
        assert fresh and folder not in elsewhere.parents
    assert [path.name for path in folder.iterdir() if path.is_dir()] == [KEY]


def test_a_cache_that_is_cleared_meanwhile(folder, temporary):
    """Whoever builds finds the folder gone, whatever that looks like: it is built elsewhere."""
    def build(work):
        if folder in work.parents:
            cache.clear_cache()
            raise RuntimeError("the compiler says something odd")
        model(work)

    made, fresh = cache.cached(KEY, build)
    assert fresh and folder not in made.parents
    assert not folder.exists() or not [path for path in folder.iterdir() if path.is_dir()]


def test_a_fault_of_the_build_is_its_own(folder):
    with pytest.raises(ZeroDivisionError):
        cache.cached(KEY, lambda work: 1 / 0)


def test_no_home_folder(monkeypatch):
    def no_home(name):
        raise RuntimeError("could not determine the home directory")

    monkeypatch.delenv(cache.ENVIRONMENT_VARIABLE, raising=False)
    monkeypatch.setattr(cache.platformdirs, "user_cache_dir", no_home)
    with pytest.raises(InputError, match=r"^no home folder .* name a folder in CARDCAGE_CACHE$"):
        cache.cached(KEY, model)
