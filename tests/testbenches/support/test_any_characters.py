"""Names of any bytes on an output of any encoding."""

import io

import pytest

from cardcage.testbenches.support.any_characters import any_characters, readable


@pytest.mark.parametrize(("encoding", "text", "written"), [
    ("utf-8", "Würfel × 2", "Würfel × 2".encode()),
    ("utf-8", "W\udcfcrfel ×", b"W\xfcrfel \xc3\x97"),
    ("utf-8", "\ud800", b"\\ud800"),  # no byte stands behind that
    ("latin-1", "Würfel \udcff →", b"W\xfcrfel \xff \\u2192"),
    ("ascii", "Würfel \udcfc", b"W\\xfcrfel \xfc"),
])
def test_every_string_can_be_printed(encoding, text, written):
    raw = io.BytesIO()
    output = io.TextIOWrapper(raw, encoding=encoding)
    any_characters(output, None, io.StringIO())  # not every output is a file
    output.write(text)
    output.flush()
    assert raw.getvalue() == written


def test_reports_are_utf_8():
    assert readable("r\udcfc ü") == "r\\udcfc ü"
