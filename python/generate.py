"""Writes signorini/_nouns.py: the nouns of the case file as classes, from its JSON Schema.

    signorini schema | python generate.py          (the command)
    python generate.py --installed                 (the schema of the installed package)

The test `tests/test_nouns.py` compares the file with what this script makes of the installed package.
"""

import json
import keyword
import pathlib
import re
import sys
import textwrap

RENAMED = {"CellsBody": "Cells"}
HEAD = '''"""The nouns of the case file as classes. Written by generate.py from the schema of the case file; do not edit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._base import Noun

if TYPE_CHECKING:
    from typing import Any, Mapping, Optional, Sequence

    from ._base import Array, Value
'''


def reference(node):
    """The name of the definition that a node refers to; None where it is none."""
    return node["$ref"].rsplit("/", 1)[-1] if "$ref" in node else None


def alternatives(node):
    """The alternatives of a node without null."""
    return [a for a in node.get("anyOf", node.get("oneOf", [])) if a.get("type") != "null"]


def split(kind):
    """The alternatives of a type: what `|` separates outside of brackets."""
    found, depth = [""], 0
    for letter in kind:
        depth += (letter in "[{") - (letter in "]}")
        if letter == "|" and depth == 0:
            found.append("")
        else:
            found[-1] += letter
    return found


def camel(word):
    return "".join(part[:1].upper() + part[1:] for part in word.split("_"))


class Schema:
    """Definitions of the schema, and the classes they become."""

    def __init__(self, schema):
        self.root = schema
        self.definitions = schema["$defs"]
        self.choices = {n: self.variants(d) for n, d in self.definitions.items() if self.variants(d)}

    def variants(self, definition):
        """Key, payload and description of each kind, where a definition is a table with one of several keys."""
        is_kind = lambda a: a.get("type") == "object" and len(a.get("properties", {})) == 1
        listed = [a for a in definition.get("oneOf", []) if is_kind(a)]
        return [(*next(iter(a["properties"].items())), a.get("description", "")) for a in listed]

    def type_of(self, node):
        """The type of a node in the notation of `_base`: a name, `[item]` for a list, `{item}` for a table of names."""
        kind = node.get("type")
        kinds = [k for k in (kind if isinstance(kind, list) else [kind]) if k != "null"]
        name = reference(node)
        if name:
            return self.named(name)
        if "array" in kinds:
            return f"[{self.type_of(node['items'])}]"
        if "object" in kinds and isinstance(node.get("additionalProperties"), dict):
            return "{" + self.type_of(node["additionalProperties"]) + "}"
        found = alternatives(node)
        if found:
            return "|".join(dict.fromkeys(self.type_of(a) for a in found))
        plain = {"string": "str", "integer": "int", "number": "float", "boolean": "bool"}
        return plain.get(kinds[0], "any") if kinds else "any"

    def named(self, name):
        definition = self.definitions[name]
        if name in self.choices:
            return f"<{name}>"
        if name == "Value":
            return "Value"
        if definition.get("type") == "object":
            return RENAMED.get(name, name)
        if "enum" in definition or all("const" in a or "enum" in a for a in alternatives(definition)):
            return "str"
        return self.type_of(definition)

    def classes(self):
        """Name, description, key of the kind, and fields or the one payload of each class."""
        made = {}

        def add(name, about, key, fields, positional=None):
            known = made.get(name)
            if known and (known[1] != key or known[2] != fields):
                raise SystemExit(f"two nouns are called {name}")
            made.setdefault(name, (about, key, fields, positional))

        for choice, variants in self.choices.items():
            for key, payload, about in variants:
                target = reference(payload)
                shared = sum(reference(p) == target for _, p, _ in variants) > 1 or target == "Nothing"
                if target in self.definitions and self.definitions[target].get("type") == "object":
                    name = camel(key) if shared else RENAMED.get(target, target)
                    definition = self.definitions[target]
                    text = about if shared else definition.get("description", about)
                    add(name, text or about, key, definition)
                else:
                    add(camel(key), about, key, None, self.type_of(payload))
        used = {reference(p) for v in self.choices.values() for _, p, _ in v}
        for name, definition in self.definitions.items():
            if definition.get("type") == "object" and name not in used:
                add(RENAMED.get(name, name), definition.get("description", ""), None, definition)
        return made

    def class_of(self, key, payload):
        """The class of a kind."""
        return next(n for n, (_, k, f, p) in self.all.items() if k == key and self.fits(payload, f, p))

    def held(self, key, payload):
        """The type of what a kind holds: the class, or the type of the one value."""
        is_value = reference(payload) in (None, "Value")
        return self.type_of(payload) if is_value else self.class_of(key, payload)

    def annotation(self, kind):
        """A type as an annotation."""
        parts = split(kind)
        if len(parts) > 1:
            return " | ".join(dict.fromkeys(self.annotation(part) for part in parts))
        if kind.startswith("<"):
            variants = self.choices[kind[1:-1]]
            names = [self.class_of(key, payload) for key, payload, _ in variants]
            plain = [self.type_of(p) for _, p, _ in variants if reference(p) in (None, "Value")]
            # One value or one list alone tells its kind.
            names += [self.annotation(p) for p in plain] if len(plain) == 1 else []
            return " | ".join([*names, "Mapping[str, Any]", "str"])
        if kind.startswith("["):
            return f"Sequence[{self.annotation(kind[1:-1])}] | Array"
        if kind.startswith("{"):
            return f"Mapping[str, {self.annotation(kind[1:-1])}]"
        if kind in ("Value", "str", "int", "float", "bool"):
            return kind
        return "Any" if kind == "any" else f"{kind} | Mapping[str, Any]"

    def fits(self, payload, fields, positional):
        target = reference(payload)
        definition = self.definitions.get(target)
        if fields is None:
            return positional == self.type_of(payload)
        return definition is not None and definition is fields

    def written(self):
        self.all = self.classes()
        root = {k: v for k, v in self.root.items() if k != "$defs"}
        parts = [HEAD, f"#: Hash of the schema, by which the tests in Rust know it.\nSCHEMA = {fingerprint(self.root)!r}", self.table()]
        for name, (about, key, fields, positional) in sorted(self.all.items()):
            parts.append(self.of_class(name, about, key, fields, positional))
        parts.append(self.of_class("ProblemKeys", root["description"], None, root, None))
        names = ", ".join(f'"{n}"' for n in sorted(self.all))
        parts.append("__all__ = [" + names + "]\n")
        return "\n\n".join(parts)

    def table(self):
        """The kinds of every choice, with the type of what each holds."""
        lines = ["#: Kinds of every choice, and the type of what each holds.", "CHOICES = {"]
        for choice, variants in sorted(self.choices.items()):
            held = ", ".join(f"{key!r}: {self.held(key, payload)!r}" for key, payload, _ in variants)
            lines.append(f"    {choice!r}: {{{held}}},")
        return "\n".join([*lines, "}"])

    def of_class(self, name, about, key, definition, positional):
        lines = [f"class {name}(Noun):"]
        if definition is None:
            lines += docstring(about, [])
            lines += ["", f"    _key = {key!r}", f"    _types = {{'value': ({key!r}, {positional!r})}}", ""]
            lines += [f"    def __init__(self, value: {self.annotation(positional)}) -> None:", "        self.value = value"]
            return "\n".join(lines) + "\n"
        required = definition.get("required", [])
        properties = definition.get("properties", {})
        order = [k for k in required if k in properties] + [k for k in properties if k not in required]
        fields = [(python_name(k), k, properties[k], k in required) for k in order]
        lines += docstring(about, [(p, self.about(node)) for p, _, node, _ in fields])
        types = ", ".join(f"{p!r}: ({k!r}, {self.type_of(node)!r})" for p, k, node, _ in fields)
        lines += ["", f"    _key = {key!r}", f"    _types = {{{types}}}", ""]
        if not fields:
            lines += ["    def __init__(self) -> None:", "        pass"]
            return "\n".join(lines) + "\n"
        lines += ["    def __init__(", "        self,", "        *,"]
        for p, _, node, needed in fields:
            kind = self.annotation(self.type_of(node))
            lines.append(f"        {p}: {kind}," if needed else f"        {p}: Optional[{kind}] = None,")
        lines.append("    ) -> None:")
        lines += [f"        self.{p} = {p}" for p, _, _, _ in fields]
        return "\n".join(lines) + "\n"

    def about(self, node):
        target = self.definitions.get(reference(node) or "", {})
        for alternative in alternatives(node):
            target = target or self.definitions.get(reference(alternative) or "", {})
        return node.get("description") or target.get("description", "")


def python_name(key):
    return key + "_" if keyword.iskeyword(key) else key


def docstring(about, fields):
    """Lines of a docstring: what a noun is, and each of its keys."""
    clean = lambda text: re.sub(r"\s+", " ", text).replace("\\", "\\\\").replace('"""', "'''").strip()
    first = clean(about) or "A table of keys."
    lines = textwrap.wrap(first, 110)
    if fields:
        lines.append("")
    for name, text in fields:
        lines += textwrap.wrap(f"{name}: {clean(text)}", 110, subsequent_indent="    ")
    indented = [("    " + line).rstrip() for line in lines]
    if len(lines) == 1:
        return [f'    """{lines[0]}"""']
    indented[0] = '    """' + lines[0]
    return [*indented, '    """']


def fingerprint(schema):
    """FNV-1a of the schema as compact JSON with sorted keys, 64 bits."""
    found = 0xCBF29CE484222325
    for byte in json.dumps(schema, separators=(",", ":"), sort_keys=True, ensure_ascii=False).encode():
        found = (found ^ byte) * 0x100000001B3 % 2**64
    return f"{found:016x}"


def generated(schema):
    """The text of signorini/_nouns.py."""
    return Schema(schema).written()


def main():
    if "--installed" in sys.argv:
        # Not the sources beside this script, which have no native part.
        sys.path = [path for path in sys.path if pathlib.Path(path or ".").resolve() != pathlib.Path(__file__).parent.resolve()]
        from signorini import _native

        schema = json.loads(_native.schema())
    else:
        schema = json.load(sys.stdin)
    target = pathlib.Path(__file__).parent / "signorini" / "_nouns.py"
    target.write_text(generated(schema), encoding="utf-8")


if __name__ == "__main__":
    main()
