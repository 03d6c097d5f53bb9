"""Pictures of results that are drawn anew, without solving."""

from __future__ import annotations

import os
import pathlib
import tempfile
from typing import Any, Optional, Sequence, Tuple, Union

from . import _native
from ._result import Result


def draw(
    results: Union[Result, str, "os.PathLike[str]"],
    path: "Union[str, os.PathLike[str], None]" = None,
    *,
    field: Optional[str] = None,
    time: Union[float, str, None] = None,
    view: Union[str, Tuple[float, float], None] = None,
    clip: Union[str, Sequence[str]] = (),
    range: Optional[Tuple[float, float]] = None,
    scale: Optional[float] = None,
    size: Optional[Tuple[int, int]] = None,
    format: str = "png",
) -> bytes:
    """Draws results anew, without solving, and returns the content of the picture.

    results: A result, or the folder of one.
    path: A file for the picture; its ending says the format: png, svg or pdf, or gif, webp or apng, which show all times.
    field: What the colours show, by its name in the files; ``"none"`` for no colours; if left out, that of most interest.
    time: The time, the nearest that is stored; ``"first"`` or ``"last"``.
    view: ``"x"``, ``"-x"``, ``"y"``, ``"-y"``, ``"z"``, ``"-z"``, ``"iso"``, or azimuth and elevation in degrees.
    clip: Half-spaces that are kept, such as ``"x<0.5"``; ``"y=0"`` keeps what is behind.
    range: The ends of the colour map, in the unit of the field.
    scale: By which displacements, or heights of membranes, are multiplied.
    size: Width and height in pixels.
    format: The format without a path.

    Raises OutputError for options that cannot be understood; the message tells what is valid.

    >>> import signorini as sg
    >>> result = sg.run(sg.gallery("string"), pictures=False)
    >>> sg.draw(result, field="displacement", view="-y")[1:4]
    b'PNG'
    """
    if isinstance(results, Result) and not results.folder:
        from ._report import store

        with tempfile.TemporaryDirectory() as made:
            store(results, pathlib.Path(made))
            return draw(
                made, path, field=field, time=time, view=view, clip=clip, range=range, scale=scale, size=size, format=format
            )
    folder: Any = results.folder if isinstance(results, Result) else results
    return _native.draw(
        os.fspath(folder),
        None if path is None else os.fspath(path),
        format,
        field,
        None if time is None else str(time),
        view if view is None or isinstance(view, str) else f"{view[0]},{view[1]}",
        [clip] if isinstance(clip, str) else list(clip),
        None if range is None else f"{range[0]}:{range[1]}",
        None if scale is None else float(scale),
        None if size is None else f"{size[0]}x{size[1]}",
    )
