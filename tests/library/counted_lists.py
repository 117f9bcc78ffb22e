"""Display lists of which only the number of triangles matters."""

from cardcage.golden.scene_display_list import make_display_list
from cardcage.golden.specification.display_list import DisplayList


def list_of(triangles: int) -> DisplayList:
    """Some triangles on a small screen, so many of them."""
    return make_display_list(f"random:n={triangles},size=4", width=16, height=8).display_list
