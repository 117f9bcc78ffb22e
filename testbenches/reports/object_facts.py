"""What was made of objects, as plain numbers, lists and words."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from ..frames.object_figures import ObjectFigures


def object_facts(figures: ObjectFigures | None) -> dict[str, Any] | None:
    """Of one picture; None where the machine takes no objects."""
    if figures is None:
        return None
    return {
        "place": figures.configuration.objects,
        **object_summary(figures),
        "per_place": [
            {"objects": golden.objects, "golden_made": golden.made,
             "golden_dropped": golden.dropped, "sent": golden.sent,
             **({} if figures.made is None or figures.dropped is None else {
                 "made": figures.made[place], "dropped": figures.dropped[place]}),
             **_forwarded(figures, place)}
            for place, golden in enumerate(figures.golden)],
        "differences": figures.differences,
    }


def object_summary(figures: ObjectFigures) -> dict[str, Any]:
    """In a few numbers, as there may be many pictures: what the host sent, what all places made and
    dropped, None where the machine was not asked, and whether all is golden's."""
    return {
        "objects": figures.objects,
        "clipped": figures.clipped,
        "meshes": figures.meshes,
        "mesh_triangles": figures.mesh_triangles,
        "link_words": asdict(figures.words) | {"total": figures.words.total},
        "golden_link_words": asdict(figures.golden_words) | {"total": figures.golden_words.total},
        "link_words_of_triangles": figures.triangle_words,
        "read": figures.made is not None,
        "made": None if figures.made is None else sum(figures.made),
        "dropped": None if figures.dropped is None else sum(figures.dropped),
        "golden_made": sum(each.made for each in figures.golden),
        "golden_dropped": sum(each.dropped for each in figures.golden),
        "equal": not figures.differences,
    }


def _forwarded(figures: ObjectFigures, place: int) -> dict[str, Any]:
    """Objects that a processing element passed on; nothing where none does."""
    if not figures.golden_forwarded:
        return {}
    golden, counted = figures.golden_forwarded, figures.forwarded
    return {"golden_forwarded": list(golden[place]),
            **({} if counted is None else {"forwarded": list(counted[place])})}
