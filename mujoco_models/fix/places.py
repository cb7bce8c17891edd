"""Which elements of a file the compiled model's bodies, geoms, joints and so on are."""

from collections.abc import Callable, Iterable, Iterator

import mujoco
import numpy as np

from mujoco_models.fix.tree import Element

_JOINTS = ("joint", "freejoint")
_MANY = {"geom": "composite", "joint": "composite", "edge": "flexcomp", "contact": "flexcomp"}
_EQUALITIES = ("connect", "weld", "joint", "tendon", "flex", "flexvert", "flexstrain")


class Places:
    """From numbers in a compiled model to elements of its file."""

    def __init__(self, model: mujoco.MjModel, root: Element) -> None:
        self.model, self.root = model, root
        self._found: dict[tuple[str, int], Element] = {}
        self._class_of: dict[int, str] = {}  # by the identity of an element
        worlds = [child for child in root.children if child.tag == "worldbody"]
        self._walk(0, [pair for world in worlds for pair in _inside(world, "main")])
        self._found["body", 0] = worlds[0] if worlds else root
        equalities = [e for c in root.children if c.tag == "equality" for e in c.children]
        equalities = [e for e in equalities if e.tag in _EQUALITIES]
        self._pair("weld", equalities, range(model.neq), model.equality)
        actuators = [e for c in root.children if c.tag == "actuator" for e in c.children]
        self._pair("actuator", actuators, range(model.nu), model.actuator)
        sensors = [e for c in root.children if c.tag == "sensor" for e in c.children]
        self._pair("sensor", sensors, range(model.nsensor), model.sensor)

    def element(self, kind: str, number: int) -> Element | None:
        """What stands for it in the file; None if that is not to be seen."""
        if (kind, number) in self._found:
            return self._found[kind, number]
        many = self.many(kind, number)
        return next((c for c in many.children if c.tag == kind), None) if many else None

    def many(self, kind: str, number: int) -> Element | None:
        """The element that makes several, this one among them."""
        tag = _MANY.get(kind, "")
        found = [e for e in self.root.below() if e.tag == tag]
        if len(found) > 1 and kind in ("geom", "joint"):
            name = getattr(self.model, kind)(number).name
            found = [e for e in found if name.startswith(e.attributes.get("prefix") or "\0")]
        return found[0] if len(found) == 1 else None

    def others(self, kind: str, elements: list[Element]) -> list[Element]:
        """All of that kind but these."""
        mine = {id(element) for element in elements}
        return [
            e
            for e in self.root.below()
            if e.tag == kind and id(e) in self._class_of and id(e) not in mine
        ]

    def defaults(self, kind: str, element: Element) -> Iterator[Element]:
        """Elements whose attributes it has by default, the nearest first."""
        name = self._class_of.get(id(element), "main")
        (root,) = element.model or (self.root,)
        ways = [way for top in root.children if top.tag == "default" for way in _ways([top])]
        while name:
            way = next((w for w in ways if w[-1].attributes.get("class", "main") == name), None)
            yield from (c for c in (way[-1].children if way else ()) if c.tag == kind)
            outer = way[-2].attributes.get("class", "main") if way and len(way) > 1 else "main"
            name = outer if name != "main" else ""

    def _walk(self, body: int, inside: list[tuple[Element, str]]) -> None:
        """What is in a body's own elements, with the class that each has by default."""
        model = self.model
        for element, inherited in inside:
            self._class_of[id(element)] = element.attributes.get("class", inherited)
        for kind, tags, bodies, named in (
            ("geom", ("geom",), model.geom_bodyid, model.geom),
            ("joint", _JOINTS, model.jnt_bodyid, model.joint),
            ("site", ("site",), model.site_bodyid, model.site),
            ("body", ("body",), model.body_parentid, model.body),
        ):
            mine = [element for element, _ in inside if element.tag in tags]
            numbers = [i for i in np.flatnonzero(bodies == body).tolist() if kind != "body" or i]
            for number, element in self._pair(kind, mine, numbers, named):
                if kind == "body":
                    inherited = next(c for e, c in inside if e is element)
                    own = element.attributes.get("childclass", inherited)
                    self._walk(number, list(_inside(element, own)))

    def _pair(
        self,
        kind: str,
        elements: list[Element],
        numbers: Iterable[int],
        named: Callable[[int], object],
    ) -> list[tuple[int, Element]]:
        """By their order, or by their names where other elements make some, too."""
        numbers = list(numbers)
        names = {getattr(named(i), "name", ""): i for i in numbers}
        if len(elements) == len(numbers):
            pairs = list(zip(numbers, elements, strict=True))
        else:
            known = [(e.attributes.get("name", ""), e) for e in elements]
            pairs = [(names[name], e) for name, e in known if name and name in names]
        self._found.update({(kind, i): e for i, e in pairs})
        return pairs


def _inside(element: Element, inherited: str) -> Iterator[tuple[Element, str]]:
    """Elements of a body, those in its frames and copies too, with the class that they inherit."""
    for child in element.children:
        if child.tag in ("frame", "replicate"):
            for _ in range(int(child.attributes.get("count", 1))):
                yield from _inside(child, child.attributes.get("childclass", inherited))
        else:
            yield child, inherited


def _ways(way: list[Element]) -> Iterator[list[Element]]:
    yield way
    for child in way[-1].children:
        if child.tag == "default":
            yield from _ways([*way, child])
