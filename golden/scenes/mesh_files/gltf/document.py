"""glTF 2.0: the JSON document and the buffers, from a ``.gltf`` or a ``.glb``."""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote_to_bytes

from ..reading import contents_error
from ..text_lines import plain_text

_MAGIC: Final = b"glTF"
_JSON, _BINARY = 0x4E4F534A, 0x004E4942

#: Extensions of which a file may demand that they be known: they change no vertex, or how
#: textures and light are drawn, which the project does not read.
_KNOWN: Final = frozenset({"KHR_mesh_quantization", "KHR_lights_punctual", "KHR_xmp",
                           "KHR_xmp_json_ld"})
_KNOWN_KINDS: Final = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_")
_NOT_KNOWN: Final = frozenset({"KHR_materials_pbrSpecularGlossiness"})


@dataclass(frozen=True)
class Document:
    """``json`` is the document; ``folder`` where its files are, ``binary`` the chunk of a .glb."""

    json: dict[str, Any]
    folder: Path
    binary: bytes | None = None

    def items(self, name: str) -> list[Any]:
        """One of the document's arrays; empty where it has none."""
        found = self.json.get(name, [])
        if not isinstance(found, list):
            raise contents_error(f"{name!r} is no array; repair the file")
        return found

    def item(self, name: str, index: Any) -> dict[str, Any]:
        """One object of an array; ``InputError`` where it is not there."""
        found = self.items(name)
        if not isinstance(index, int) or isinstance(index, bool) or not 0 <= index < len(found):
            raise contents_error(f"{name}[{index}] is named, but there are {len(found)}; repair "
                                 "the file")
        if not isinstance(found[index], dict):
            raise contents_error(f"{name}[{index}] is no object; repair the file")
        item: dict[str, Any] = found[index]
        return item


def read_document(data: bytes, folder: Path) -> Document:
    """Raises ``InputError`` for a file that is cut short, of another version, or that demands
    an extension which is not known here."""
    binary = None
    if data.startswith(_MAGIC):
        text, binary = _chunks(data)
    else:
        text = data
    try:
        document = json.loads(plain_text(text))
    except (ValueError, RecursionError) as error:
        raise contents_error(f"not a readable glTF ({error}); export it again") from None
    if not isinstance(document, dict):
        raise contents_error("not a glTF: its JSON is no object")
    asset = document.get("asset", {})
    version = asset.get("version", "2.0") if isinstance(asset, dict) else "2.0"
    if not str(version).startswith("2."):
        raise contents_error(f"glTF {version}; export it as glTF 2.0")
    required = document.get("extensionsRequired", [])
    unknown = [name for name in required if name in _NOT_KNOWN
               or not (name in _KNOWN or str(name).startswith(_KNOWN_KINDS))]
    if unknown:
        raise contents_error(f"requires {', '.join(map(str, unknown))}, which cannot be read; "
                             "export it without")
    return Document(document, folder, binary)


def _chunks(data: bytes) -> tuple[bytes, bytes | None]:
    """The JSON and the binary chunk of a ``.glb``."""
    version = int.from_bytes(data[4:8], "little")
    length = int.from_bytes(data[8:12], "little")
    if len(data) < 20 or length > len(data):
        raise contents_error(f"{length} bytes are announced and {len(data)} are there: the file "
                             "is cut short")
    if version != 2:
        raise contents_error(f"a .glb of version {version}; export it as glTF 2.0")
    if data[length:].strip(b"\0 \t\r\n"):
        raise contents_error(f"{len(data) - length} bytes after the {length} that the file "
                             "announces; export it again")
    chunks = dict(reversed(list(_each_chunk(data[:length]))))
    if _JSON not in chunks:
        raise contents_error("a .glb without JSON; export it again")
    return chunks[_JSON], chunks.get(_BINARY)


def _each_chunk(data: bytes) -> Iterator[tuple[int, bytes]]:
    at = 12
    while at + 8 <= len(data):
        size, kind = (int.from_bytes(data[at + i : at + i + 4], "little") for i in (0, 4))
        if at + 8 + size > len(data):
            raise contents_error(f"a chunk of {size} bytes in the {len(data) - at - 8} that are "
                                 "left: the file is cut short or damaged")
        yield kind, data[at + 8 : at + 8 + size]
        at += 8 + size


def read_buffer(document: Document, index: int) -> bytes:
    """The bytes of one buffer: of the .glb itself, a data URI, or a file beside the document."""
    buffer = document.item("buffers", index)
    length = buffer.get("byteLength", 0)
    uri = buffer.get("uri")
    if uri is None:
        if index != 0 or document.binary is None:
            raise contents_error(f"buffer {index} has neither a file nor a binary chunk; export "
                                 "it again")
        data, name = document.binary, "its binary chunk"
    elif uri.startswith("data:"):
        data, name = _data_uri(uri, index), f"buffer {index}"
    else:
        data, name = _file(document.folder, uri)
    if len(data) < length:
        raise contents_error(f"{name} has {len(data)} of the {length} bytes that are announced: "
                             "it is cut short")
    return data


def _data_uri(uri: str, index: int) -> bytes:
    head, comma, body = uri.partition(",")
    raw = unquote_to_bytes(body)
    if not comma:
        raise contents_error(f"buffer {index}: a data URI without data; export it again")
    if not head.endswith(";base64"):
        return raw
    try:
        return base64.b64decode(raw, validate=True)
    except binascii.Error as error:
        raise contents_error(f"buffer {index}: no base64 ({error}); export it again") from None


def _file(folder: Path, uri: str) -> tuple[bytes, str]:
    scheme = uri.split(":", 1)[0] if ":" in uri else ""
    if len(scheme) > 1 and scheme.isalnum() and "/" in uri:
        raise contents_error(f"buffer {uri!r} is not a file beside it; download it, or export with "
                             "the data inside")
    # Percent signs stand for bytes; some exporters write them as they are.
    for name in (unquote_to_bytes(uri).decode("utf-8", "surrogateescape"), uri):
        path = folder / name
        try:
            return path.read_bytes(), repr(name)
        except FileNotFoundError:
            continue
        except (OSError, ValueError) as error:
            raise contents_error(f"buffer {name!r} cannot be read ("
                                 f"{getattr(error, 'strerror', None) or error})") from None
    raise contents_error(f"buffer {name!r} is missing: no such file; put it beside the .gltf")
