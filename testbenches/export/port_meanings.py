"""What the docstrings of components and of their interfaces say: ports, latency, throughput."""

import inspect
import re
from collections.abc import Iterator
from typing import Any

from amaranth.hdl import Shape, Value
from amaranth.lib import data, stream, wiring

__all__ = ["described_ports", "ports_in_parts", "stated_timing"]

_HEADER = re.compile(r"(\w+(?:, \w+)*): (?:In|Out)(?:\((.*?)\))?(?: \[.*?\])?(?=, \w+:|$)")

#: What a stream's own signals mean; its class has no such table.
_STREAM = {
    "valid": "a word is offered, and held until it is taken",
    "ready": "the word is taken in this clock, if one is offered",
    "payload": "the word",
}

#: What means the same wherever it comes without a text of its own.
_COMMON = {
    "access": "to the RAM",
    "back": "which of the two colours is drawn into",
    "depth_tag": "current tag of the depths",
    "grid": "the machine's own resolution",
    "left": "from or to the left",
    "lines": "to the memory units",
    "memory": "to the memory units of the domain",
    "pictures": "the picture shown and the one drawn",
    "pins": "to the screen",
    "read": "request to read a depth",
    "read_back_start": "begin to send the depths",
    "red": "red of the pixel",
    "green": "green of the pixel",
    "blue": "blue of the pixel",
    "scan": "lines of the video scan generator",
    "broadcast": "lines of the central broadcast controller",
    "survey_start": "begin to survey",
    "total": "number of memory units in the cage",
    "right": "from or to the right",
    "write": "request to write",
}


def described_ports(component: wiring.Component) -> list[dict[str, Any]]:
    """Every port of a component's module, besides ``clk`` and ``rst``: ``name``, ``direction``,
    ``width``, ``meaning`` and, of structures, ``fields`` with bit offset and width.

    Signals of no bits are no ports in Verilog and are left out.
    """
    return [{**port, "meaning": ": ".join(port["meaning"])} for port in ports_in_parts(component)]


def ports_in_parts(component: wiring.Component) -> list[dict[str, Any]]:
    """The same, but ``meaning`` a list of texts, from the member of the component inwards."""
    ports = []
    for path, member, value in component.signature.flatten(component):
        width = len(Value.cast(value))
        if width:
            port: dict[str, Any] = {
                "name": "__".join(map(str, path)),
                "direction": "input" if member.flow == wiring.In else "output",
                "width": width,
                "meaning": _meanings(component, path),
            }
            if isinstance(member.shape, data.Layout):
                port["fields"] = list(_fields(member.shape))
            ports.append(port)
    return ports


def stated_timing(component: wiring.Component) -> dict[str, Any]:
    """The clocks of ``latency`` and of ``interval``, where a component has such figures, and what
    it says of time."""
    paragraphs = (inspect.getdoc(type(component)) or "").split("\n\n")
    stated = [_plain(text) for text in paragraphs if text.startswith("Latency")]
    if not stated and any("Combinational." in text for text in paragraphs):
        stated = ["Combinational."]
    intervals = {"interval_clocks": component.interval} if hasattr(component, "interval") else {}
    return {"latency_clocks": getattr(component, "latency", None), **intervals,
            "stated": " ".join(stated)}


def _meanings(component: wiring.Component, path: tuple[str | int, ...]) -> list[str]:
    described, signature, texts = type(component), component.signature, []
    for name in path:
        if isinstance(name, int):  # an element of an array: described with it
            continue
        if isinstance(signature, stream.Signature):
            texts.append(_STREAM[name])
            break
        # A component may have the ports of a signature that has a name.
        texts.append(_members(described).get(name) or _members(type(signature)).get(name)
                     or _COMMON.get(name, ""))
        member = signature.members[name]
        if member.is_signature:
            signature = member.signature
            if isinstance(signature, wiring.FlippedSignature):
                signature = signature.flip()  # the one that is documented
            described = type(signature)
    return [text.rstrip(".") for text in texts if text]


def _members(described: type) -> dict[str, str]:
    """Name → text in the sections Members of a class and of those it is derived from."""
    texts: dict[str, str] = {}
    for each in reversed(described.__mro__):
        texts |= _members_in(inspect.cleandoc(each.__doc__ or ""))
    return texts


def _members_in(docstring: str) -> dict[str, str]:
    """Those in one docstring; a text belongs to the line above it."""
    _, _, section = docstring.partition("Members\n-------\n")
    texts: dict[str, str] = {}
    names: list[str] = []
    for line in section.partition("\n\n")[0].splitlines():
        if line.startswith("    "):
            for name in names:
                texts[name] = f"{texts[name]} {_plain(line)}".strip()
            continue
        names = []
        for found in _HEADER.finditer(line):
            for name in found[1].split(", "):
                # "stream of …" says what runs there.
                shape = found[2] or ""
                texts[name] = f"{shape}." if shape.startswith("stream of ") else ""
                names.append(name)
    return texts


def _plain(text: str) -> str:
    return " ".join(text.replace("``", "").split())


def _fields(layout: data.Layout, prefix: str = "",
            offset: int = 0) -> Iterator[dict[str, str | int]]:
    for name, field in layout:
        start = offset + field.offset
        yield {"name": f"{prefix}{name}", "offset": start, "width": Shape.cast(field.shape).width}
        if isinstance(field.shape, data.Layout):
            yield from _fields(field.shape, f"{prefix}{name}.", start)
