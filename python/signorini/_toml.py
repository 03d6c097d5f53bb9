"""Case files from plain tables."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np

#: Tables whose entries are tables with a heading of their own.
NAMED = ("supports", "loads", "contacts", "constraints", "functions", "paths", "winding", "ropes")
ALONE = ("constants", "output", "limits", "fit")


def written(tree: dict) -> str:
    """The text of a case file."""
    lines: list = []
    tables = ("bodies", "steps", *NAMED, *ALONE)
    _entries(lines, {k: v for k, v in tree.items() if k not in tables})
    if "constants" in tree:
        _section(lines, "[constants]", tree["constants"])
    for name, body in tree.get("bodies", {}).items():
        kinds = list(body) if isinstance(body, dict) else []
        if len(kinds) == 1 and isinstance(body[kinds[0]], dict):
            _section(lines, f"[bodies.{_key(name)}.{_key(kinds[0])}]", body[kinds[0]])
        else:
            _section(lines, "[bodies]", {name: body})
    for group in NAMED:
        for name, table in tree.get(group, {}).items():
            _section(lines, f"[{group}.{_key(name)}]", table)
    for step in tree.get("steps", []):
        _section(lines, "[[steps]]", step)
    for name in ALONE[1:]:
        if name in tree:
            _section(lines, f"[{name}]", tree[name])
    return "\n".join(lines).lstrip("\n") + "\n"


def _section(lines: list, heading: str, table: dict) -> None:
    lines += ["", heading]
    _entries(lines, table)


def _entries(lines: list, table: dict) -> None:
    for key, value in table.items():
        if isinstance(value, dict) and len(value) == 1:
            (kind, held), = value.items()
            lines.append(f"{_key(key)}.{_key(kind)} = {_value(held)}")
        else:
            lines.append(f"{_key(key)} = {_value(value)}")


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _text(name)


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, tuple):
        kind, shape, content = value
        return _value(np.frombuffer(content, "<" + kind).reshape(shape).tolist())
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    inner = ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items())
    return "{ " + inner + " }" if inner else "{}"
