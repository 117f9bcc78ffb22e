"""What the main program of all compiled models has to know: the text of model_constants.h."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from ...golden.specification import commands
from ...golden.specification.activity import ACTIVITY_BITS
from .activity_record import BUCKETS, DRAWING


class RecordKind(bytes, Enum):
    """The byte that a record of the results begins with."""

    RESPONSE = b"R"  # kind, value, cycle
    SCAN = b"S"  # cycle, picture
    ACTIVITY = b"A"  # first cycle, clocks, clocks a bucket, buckets, and the counts of each
    COMMANDS = b"C"  # how many were taken, and the cycle of each
    END = b"E"  # why, cycles, and a reason


class End(bytes, Enum):
    """Why a run ended."""

    DONE = b"D"
    MAXIMUM = b"M"  # ``maximum_cycles`` is reached
    VIDEO = b"V"  # the video output is malformed


def model_constants() -> str:
    """The header: the codes of all that passes, and how long fields are."""
    values = {
        "OPCODE_BITS": commands.OPCODE_BITS,
        "RESPONSE_KIND_BITS": commands.RESPONSE_KIND_BITS,
        "ACTIVITY_BITS": ACTIVITY_BITS,
        "BUCKETS": BUCKETS,
        "DRAWING_OPCODES": sum(1 << opcode for opcode in DRAWING),  # a bit each
    }
    return "\n".join([
        *(f"constexpr unsigned {name} = {value};" for name, value in values.items()),
        _codes("Opcode", "uint8_t", ((opcode.name, int(opcode)) for opcode in commands.Opcode)),
        _codes("ResponseKind", "uint8_t",
               ((kind.name, int(kind)) for kind in commands.ResponseKind)),
        _codes("RecordKind", "char", ((record.name, ord(record)) for record in RecordKind)),
        _codes("End", "char", ((end.name, ord(end)) for end in End)),
    ]) + "\n"


def _codes(name: str, of: str, members: Iterable[tuple[str, int]]) -> str:
    """The members of an enumeration as constants in a namespace of its name."""
    lines = (f"constexpr {of} {member} = {value};" for member, value in members)
    return "\n".join([f"namespace {name} {{", *lines, "}"])
