"""Write a copy of a model with some edits, the rest of its text as it is."""

import re
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from xml.sax.saxutils import quoteattr

import mujoco

from analytic.problem.errors import InputError
from mujoco_models.fix.edit import Edit, Insert
from mujoco_models.fix.places import Places
from mujoco_models.fix.tree import Element, Place, read_tree

_MANY = 3  # elements for which a default is edited, or made


def fixed(
    path: Path, model: mujoco.MjModel, edits: Iterable[Edit | Insert], out: Path
) -> tuple[Path, ...]:
    """Write the model as `out`, and files that it includes beside it if they change.

    Returns what was written. What MuJoCo does not take is not left behind.
    """
    if path.suffix != ".xml":
        raise InputError("--write", path, "MJCF", "URDF has no place for what is to be set")
    if out.resolve() == path.resolve():
        raise InputError("--write", out, "another file than the model", "name a new one")
    texts = Texts(Places(model, read_tree(path)), path)
    for edit in edits:
        if isinstance(edit, Insert):
            texts.insert(edit)
        else:
            texts.set(edit)
    written = texts.write(path, out)
    try:
        mujoco.MjModel.from_xml_path(str(out))
    except (ValueError, mujoco.FatalError) as error:
        for file in written:
            file.unlink()
        said = " ".join(str(error).split())[:200]
        raise InputError(
            "--write", out, "such that MuJoCo takes the fixed model",
            f"write it into {path.parent}, beside what it includes ({said})",
        ) from error  # fmt: skip
    return written


class Texts:
    """Changes of files, by their places in bytes."""

    def __init__(self, places: Places, main: Path) -> None:
        self._places, self._main = places, main
        self._changes: dict[Path, dict[tuple[int, int], str]] = defaultdict(dict)
        self._bytes: dict[Path, bytes] = {}
        self._new: dict[str, dict[str, str]] = defaultdict(dict)  # of a default to be made, by kind
        # By the place of an element, and of a kind that is to be made in it.
        self._attributes: dict[Place, dict[str, str]] = defaultdict(dict)
        self._within: dict[Place, dict[str, dict[str, str]]] = defaultdict(
            lambda: defaultdict(dict)
        )
        self._elements: dict[Place, Element] = {}

    def set(self, edit: Edit) -> None:
        """Where an attribute stands already; else in a default of many, or in each element."""
        if edit.of_all:
            self._set_option(edit.kind, dict(edit.attributes))
            return
        found = [self._places.element(edit.kind, i) for i in edit.numbers]
        many = self._places.many(edit.kind, edit.numbers[0])
        if None in found and many is not None:
            self._within[many.place][edit.kind].update(edit.attributes)
            self._elements[many.place] = many
            return
        if None in found:
            raise InputError(
                "--write", f"{edit.kind} {edit.numbers[found.index(None)]} of the model",
                "one that its file states",
                "another element makes it, or <compiler> discards or fuses what stands beside it: "
                f"set {edit} there",
            )  # fmt: skip
        elements = list({e.place: e for e in found if e is not None}.values())
        if edit.kind == "joint" and {"stiffness", "damping"}.intersection(dict(edit.attributes)):
            for number, element in zip(edit.numbers, found, strict=True):
                self._state_springdamper(number, element)
        for name, value in edit.attributes:
            own = [e for e in elements if name in {**e.attributes, **self._given(e)}]
            others = [e for e in elements if e not in own]
            for element in own:
                self._give(element, name, value)
            if len(others) < _MANY:
                for element in others:
                    self._give(element, name, value)
            else:
                self._set_default(edit.kind, others, name, value)

    def _state_springdamper(self, number: int, joint: Element | None) -> None:
        """As the stiffness and damping that MuJoCo made of it, which it would override."""
        model = self._places.model
        if joint is None or not any(
            "springdamper" in e.attributes for e in (joint, *self._places.defaults("joint", joint))
        ):
            return
        stiffness = model.jnt_stiffness[number]
        damping = model.dof_damping[model.jnt_dofadr[number]]
        made = {"springdamper": "0 0", "stiffness": f"{stiffness:.6g}", "damping": f"{damping:.6g}"}
        for name, value in made.items():
            if name not in self._given(joint):
                self._give(joint, name, value)

    def _given(self, element: Element) -> dict[str, str]:
        return self._attributes.get(element.place, {})

    def _set_default(self, kind: str, elements: list[Element], name: str, value: str) -> None:
        """In the default that they have; in each of them if others have it, too."""
        chains = [list(self._places.defaults(kind, e)) for e in elements]
        where: list[Element | None] = [
            next((d for d in chain if name in d.attributes), chain[0] if chain else None)
            for chain in chains
        ]
        of_all = {id(d) for d in where}
        for other in self._places.others(kind, elements):
            shared = {id(None), *(id(d) for d in self._places.defaults(kind, other))}
            if of_all & shared:
                where = [*elements]
        where = [e if d is None and e.model else d for d, e in zip(where, elements, strict=True)]
        for element in where:
            if element is not None:
                self._give(element, name, value)
            elif value:
                self._new[kind][name] = value

    def insert(self, new: Insert) -> None:
        """At the beginning of a body, around it, or at the end of the file."""
        if new.body is None:
            root = self._places.root
            self._change(self._main, root.end, root.end, f"  {new.text}\n")
            return
        if new.around:
            self._put_around(new, new.body)
            return
        element = self._places.element("body", new.body)
        if element is None or element.model:
            name = self._places.model.body(new.body).name or new.body
            raise InputError(
                "--write", f"body {name!r}", "one that the model's own file states",
                f"put {new.text} into a body there, and what another element or file makes into "
                "that",
            )  # fmt: skip
        self._put_into(element, new.text)
        if new.text.startswith("<joint"):
            self._widen_keys(new.body)
            self._free_keys(int(self._places.model.body_mocapid[new.body]))

    def _put_around(self, new: Insert, body: int) -> None:
        """Only beside it where it does not stand in its parent itself, but in a frame, say."""
        places, parent = self._places, int(self._places.model.body_parentid[body])
        inner, outer = places.element("body", body), places.element("body", parent)
        if inner is None:
            inner = places.many("geom", int(places.model.body_geomadr[body]))
        if (
            inner is None
            or inner.model
            or outer is None
            or all(inner is not e for e in outer.children)
        ):
            self.insert(Insert(new.text, parent))
            return
        end = self._text(inner.file).index(b">", inner.end) + 1
        self._change(inner.file, inner.start, inner.start, f'<body name="{new.around}">{new.text}')
        self._change(inner.file, end, end, "</body>")

    def _widen_keys(self, body: int) -> None:
        """Give keyframes a place and a speed of a joint that comes first in a body."""
        model = self._places.model
        later = model.jnt_bodyid >= body
        keys = [e for e in self._places.root.below() if e.tag == "key"]
        for name, starts, count in (
            ("qpos", model.jnt_qposadr, model.nq), ("qvel", model.jnt_dofadr, model.nv),
        ):  # fmt: skip
            at = int(starts[later].min(initial=count))
            for key in (key for key in keys if name in key.attributes):
                numbers = key.attributes[name].split()
                self._give(key, name, " ".join([*numbers[:at], "0", *numbers[at:]]))

    def _free_keys(self, mocap: int) -> None:
        """Take from keyframes where a mocap body was that a joint moves now."""
        keys = [e for e in self._places.root.below() if e.tag == "key" and mocap >= 0]
        for name, count in (("mpos", 3), ("mquat", 4)):
            for key in (key for key in keys if name in key.attributes):
                numbers = key.attributes[name].split()
                del numbers[count * mocap : count * (mocap + 1)]
                self._give(key, name, " ".join(numbers))

    def _put_into(self, element: Element, text: str) -> None:
        end = self._end_of_tag(element)
        if self._text(element.file)[end - 2 : end] == b"/>":
            self._change(element.file, end - 2, end, f">{text}</{element.tag}>")
        else:
            self._change(element.file, end, end, f"{self._indent(element)}  {text}")

    def _set_option(self, kind: str, attributes: dict[str, str]) -> None:
        """Where it is stated last, as MuJoCo reads it."""
        options = [e for e in self._places.root.children if e.tag == "option"]
        if kind == "flag":
            options = [e for option in options for e in option.children if e.tag == "flag"]
        for name, value in attributes.items():
            stated = [e for e in options if name in e.attributes] or options[:1]
            if stated:
                self._give(stated[-1], name, value)
            else:
                self._new["option"][name] = value

    def _give(self, element: Element, name: str, value: str) -> None:
        self._attributes[element.place][name] = value
        self._elements[element.place] = element

    def _text(self, file: Path) -> bytes:
        return self._bytes.setdefault(file, file.read_bytes())

    def _end_of_tag(self, element: Element) -> int:
        """Behind the > of its start tag."""
        quoted = re.compile(rb"""<(?:[^>"']|"[^"]*"|'[^']*')*>""")
        found = quoted.match(self._text(element.file), element.start)
        assert found is not None
        return found.end()

    def _indent(self, element: Element) -> str:
        text = self._text(element.file)
        line = text.rfind(b"\n", 0, element.start) + 1
        lead = text[line : element.start]
        return "\n" + (lead.decode() if not lead.strip() else "")

    def _change(self, file: Path, start: int, end: int, text: str) -> None:
        before = self._changes[file].get((start, end), "")
        self._changes[file][start, end] = before + text

    def write(self, path: Path, out: Path) -> tuple[Path, ...]:
        """All files that change; the model itself even if none does."""
        for key, kinds in self._within.items():
            self._put_into(self._elements[key], "".join(_tag(k, a) for k, a in kinds.items()))
        for key, attributes in self._attributes.items():
            element = self._elements[key]
            start, end = element.start, self._end_of_tag(element)
            tag = self._text(element.file)[start:end].decode()
            for name, value in attributes.items():
                tag = _with(tag, name, value)
            self._change(element.file, start, end, tag)
        if self._new:
            root = self._places.root
            end = self._end_of_tag(root)
            lines = [_tag("option", self._new.pop("option"))] if "option" in self._new else []
            if self._new:
                inner = "".join(_tag(kind, given) for kind, given in self._new.items())
                lines.append(f"<default>{inner}</default>")
            self._change(self._main, end, end, "".join(f"\n  {line}" for line in lines))
        files = {element.file for element in self._places.root.below()}
        changed = set(self._changes)
        while more := {f for f in files - changed for g in changed if self._include_of(g, f)}:
            changed |= more
        copies = {f: out.with_name(f"{out.stem}-{f.name}") for f in changed - {self._main}}
        for included, copy in copies.items():
            for file in changed:
                if found := self._include_of(included, file):
                    self._change(file, *found.span(1), copy.name)
        for file, copy in (*copies.items(), (self._main, out)):
            copy.write_bytes(self._changed(file))
        return (out, *copies.values())

    def _include_of(self, included: Path, file: Path) -> re.Match[bytes] | None:
        """Where a file includes or attaches another one: the name in it."""
        for found in re.finditer(
            rb"""<(?:include|model)\s[^>]*?file\s*=\s*["']([^"']+)""", self._text(file)
        ):
            if self._main.parent / found[1].decode() == included:
                return found
        return None

    def _changed(self, file: Path) -> bytes:
        text = self._text(file)
        for (start, end), new in sorted(self._changes[file].items(), reverse=True):
            text = text[:start] + new.encode() + text[end:]
        return text


def _with(tag: str, name: str, value: str) -> str:
    """A start tag with another value of an attribute, or without it."""
    stated = re.compile(rf"""(\s+){name}(\s*=\s*)(["']).*?\3""", re.DOTALL)
    if stated.search(tag):
        with_value = rf"\g<1>{name}\g<2>\g<3>{value}\g<3>" if value else ""
        return stated.sub(with_value, tag, count=1)
    if not value:
        return tag
    end = "/>" if tag.endswith("/>") else ">"
    return f'{tag[: -len(end)].rstrip()} {name}="{value}"{end}'


def _tag(name: str, attributes: dict[str, str]) -> str:
    return f"<{name}{''.join(f' {k}={quoteattr(v)}' for k, v in attributes.items())}/>"
