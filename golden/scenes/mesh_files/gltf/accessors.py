"""glTF accessors: the typed arrays of a document, whatever way they are stored."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from ..reading import contents_error
from .document import Document, read_buffer

_COMPONENTS: Final = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
#: Matrices; columns of bytes or shorts are padded to multiples of four bytes.
_SIDES: Final = {"MAT2": 2, "MAT3": 3, "MAT4": 4}


class Accessors:
    """The accessors of a document; each buffer is read once."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._buffers: dict[int, bytes] = {}

    def numbers(self, index: Any) -> NDArray[np.float64]:
        """float64 (count, width); normalised integers are divided by their full scale."""
        accessor = self._document.item("accessors", index)
        array = self._array(accessor, index)
        numbers = array.astype(np.float64)
        if accessor.get("normalized") and array.dtype.kind != "f":
            # The least of the signed integers would lie below -1.
            numbers = np.maximum(numbers / np.iinfo(array.dtype).max, -1.0)
        return numbers

    def indices(self, index: Any) -> NDArray[np.int64]:
        """int64 (count,)"""
        array = self._array(self._document.item("accessors", index), index)
        if array.dtype.kind == "f" or array.shape[1] != 1:
            raise contents_error(f"accessor {index} holds no indices; export it again")
        return array[:, 0].astype(np.int64)

    def _array(self, accessor: dict[str, Any], index: int) -> NDArray[Any]:
        kind, component = accessor.get("type"), accessor.get("componentType")
        if component not in _COMPONENTS or kind not in (*_WIDTHS, *_SIDES):
            raise contents_error(f"accessor {index} is of type {kind} of {component}, which glTF "
                                 "does not know; export it again")
        dtype = np.dtype(_COMPONENTS[component])
        width = _WIDTHS[kind] if kind in _WIDTHS else _SIDES[kind] ** 2
        count = accessor.get("count", 0)
        if not isinstance(count, int) or count < 0:
            raise contents_error(f"accessor {index} has a count of {count}; export it again")
        if "bufferView" in accessor:
            array = self._view(accessor, dtype, width, count, f"accessor {index}",
                               _SIDES.get(str(kind)))
        else:
            array = np.zeros((count, width), dtype)
        sparse = accessor.get("sparse")
        if sparse is None:
            return array
        number = sparse["count"]
        where = self._view(sparse["indices"], np.dtype(_COMPONENTS[
            sparse["indices"]["componentType"]]), 1, number, f"accessor {index}")[:, 0]
        values = self._view(sparse["values"], dtype, width, number, f"accessor {index}")
        if number and int(where.max()) >= count:
            raise contents_error(f"accessor {index}: a sparse value for element {where.max()} of "
                                 f"{count}; export it again")
        array = array.copy()
        array[where] = values
        return array

    def _view(
        self, stored: dict[str, Any], dtype: np.dtype[Any], width: int, count: int, name: str,
        side: int | None = None,
    ) -> NDArray[Any]:
        """``count`` elements of ``width`` numbers in a buffer view, packed or spread."""
        view = self._document.item("bufferViews", stored.get("bufferView"))
        buffer: int = view["buffer"]
        if buffer not in self._buffers:
            self._buffers[buffer] = read_buffer(self._document, buffer)
        data = self._buffers[buffer]
        first, size = view.get("byteOffset", 0), view["byteLength"]
        offset = stored.get("byteOffset", 0)
        column = 0 if side is None else -(-side * dtype.itemsize // 4) * 4
        element = width * dtype.itemsize if side is None else column * side
        stride = view.get("byteStride") or element
        if min(first, size, offset) < 0 or stride < element or first + size > len(data):
            raise contents_error(f"{name} lies outside of its buffer of {len(data)} bytes; the "
                                 "file is cut short or damaged")
        needed = offset + stride * (count - 1) + element
        if count and needed > size:
            raise contents_error(f"{name} needs {needed} bytes and its buffer view has {size}; the "
                                 "file is cut short or damaged")
        if not count:
            return np.zeros((0, width), dtype)
        if side is None:
            return np.ndarray((count, width), dtype, data, first + offset,
                              (stride, dtype.itemsize))
        return np.ndarray((count, side, side), dtype, data, first + offset,
                          (stride, column, dtype.itemsize)).reshape(count, width)
