"""Mutants of URDF texts: structure, numbers, names, spelling."""

from __future__ import annotations

import copy
import functools
import importlib.util
import random
import xml.etree.ElementTree as ET
from pathlib import Path


def shipped(folder: str = "urdf") -> Path | None:
    """The folder of the shipped robots that belong to the kinlab under test."""
    found = importlib.util.find_spec("kinlab")
    assert found is not None and found.origin is not None
    package = Path(found.origin).parent
    for place in (package.parent / "robots" / folder, package / "robots" / folder):
        if place.is_dir():
            return place
    return None


ROBOTS = shipped()

TWO_LINK = """<robot name="two">
  <link name="base"/>
  <link name="upper"><inertial><origin xyz="0.3 0.02 -0.01" rpy="0.1 0.2 0.3"/><mass value="3"/>
    <inertia ixx="0.05" ixy="0.001" ixz="0.002" iyy="0.06" iyz="0.003" izz="0.04"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0.2 0 0"/><mass value="2"/>
    <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.025"/></inertial></link>
  <link name="hand"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0.1 0.4" rpy="0.2 -0.3 0.5"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="10" velocity="5"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.6 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="wrist" type="fixed"><parent link="lower"/><child link="hand"/>
    <origin xyz="0.4 0 0" rpy="0 0.7 0"/></joint>
</robot>"""

SLIDER = """<robot name="slider">
  <link name="floor"/>
  <link name="cart"><inertial><mass value="4"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rod"><inertial><origin xyz="0 0 0.5"/><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.01"/></inertial></link>
  <link name="flag"><inertial><mass value="0.5"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="rail" type="prismatic"><parent link="floor"/><child link="cart"/>
    <axis xyz="1 1 0"/><limit lower="-1" upper="1" effort="10" velocity="5"/></joint>
  <joint name="pin" type="revolute"><parent link="cart"/><child link="rod"/>
    <origin xyz="0 0 0.2" rpy="1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="10" velocity="5"/></joint>
  <joint name="side" type="revolute"><parent link="cart"/><child link="flag"/>
    <origin xyz="0.3 0 0"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>"""

SPELLINGS = [
    " 5 ", "5_0", "٥", "\u00a05", "5\u00a0", "\u20035", "1e400", "-1e400", "nan", "NaN", "0x10",
    "1,5", "+5", "5.", ".5", "1e-320", "1e-400", "infinity", "-inf", "-0", "", " ", "1e5", "1E+2",
    "5d0", "5f", "1e", "--5", "+-5", "5 5", "5\t", "\n5", "1_000.5", "０.５", "1.5.2", "pi", "5%",
    "1e200", "-1e200", "1e-200", "0.1e1", "00005", "5;", "٣.٥", "²", "½", "1e+", "0b1", "1/2",
    "0.30000000000000004", "1" * 60, "0." + "3" * 90, "\u22125", "5\u200b", "\ufeff5", "1e308",
]  # fmt: skip
AXES = [
    "0 0 1e200", "0 0 1e-200", "1e-320 0 0", "1e200 1e200 0", "0 0 0", "0 0 1 0", "0 0", "0 0 -1",
    "1 1 1", "3e-160 4e-160 0", "1e308 1e308 1e308", "1 0 1e-9", "0 0 1e-30", "nan 0 1", "2 0 0",
    "0,0,1", "0 0 \u00a01", "1e-5 1e-5 0", "1e-13 0 0", "1e16 1 0", "0 0 1_0", "٠ ٠ ١",
]  # fmt: skip
NAMES = [
    "{x}", "{0}", "{", "%s", "a b", "", " ", "universe", "root_joint", "[/bold]", "\x7f", "é", "日本",
    "a/b", "a" * 300, "x\u202ey", "&lt;b&gt;", "<script>", "'", '"', "..", "base", "upper", "lower",
    "hand", "shoulder", "elbow", "link_1", "joint_1", "tool",
]  # fmt: skip
NUMERIC = {"xyz", "rpy", "value", "ixx", "ixy", "ixz", "iyy", "iyz", "izz", "lower", "upper",
           "effort", "velocity", "radius", "length", "size", "rgba", "scale", "gravity",
           "armature", "multiplier", "offset", "damping", "friction"}  # fmt: skip
PARTS = [
    "<axis/>", '<axis xzy="0 0 1"/>', '<axis xyz="0 1 0"/>', "<origin/>", '<origin xyz="1 2 3"/>',
    '<origin rpy="1 2 3"/>', "<inertial/>", '<mass value="7"/>', "<mass/>", "<inertia/>",
    '<limit lower="-9" upper="9" effort="1" velocity="1"/>', "<limit/>", '<mimic joint="shoulder"/>',
    '<mimic joint="nobody" multiplier="2"/>', "<geometry/>", "<visual><geometry/></visual>",
    '<visual><geometry><mesh filename="no.stl"/></geometry></visual>',
    '<visual><geometry><box size="a b"/></geometry></visual>',
    '<collision><geometry><sphere radius="x"/></geometry></collision>',
    '<visual><geometry><sphere radius="1"/></geometry><material name="m"><color rgba="a"/></material></visual>',
    '<inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1"/></inertial>',
    '<dynamics damping="x"/>', '<safety_controller k_velocity="q"/>', "<calibration/>",
    '<transmission name="t"/>', '<material name="m"/>', '<gazebo reference="base"/>',
    '<kinlab gravity="0 0 0"/>', '<kinlab gravity="1 2 nan"/>', '<kinlab><joint name="x"/></kinlab>',
    '<link name="extra"/>', '<joint name="extra" type="fixed"/>', '<parent link="base"/>',
    '<child link="base"/>', '<x:axis xmlns:x="u" xyz="0 1 0"/>', '<robot name="inner"/>',
]  # fmt: skip
KINDS = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical",
         "Revolute", " revolute", "screw", "", "unknown"]  # fmt: skip


def _all(root: ET.Element) -> list[tuple[ET.Element, ET.Element]]:
    return [(parent, child) for parent in root.iter() for child in parent]


def _number(rng: random.Random, text: str) -> str:
    words = text.split() or [""]
    i = rng.randrange(len(words))
    words[i] = rng.choice(SPELLINGS)
    return rng.choice([" ", " ", "  ", "\t", "\n", "\u00a0"]).join(words)


def structural(rng: random.Random, text: str) -> tuple[str, str]:
    """One or two changes of the tree; the text and what was done."""
    root = ET.fromstring(text)
    done = []
    for _ in range(rng.choice([1, 1, 1, 2])):
        pairs = _all(root)
        weights = [6 if any(k in NUMERIC for k in c.attrib) else 2 for _, c in pairs]
        parent, child = rng.choices(pairs, weights)[0]
        where = f"<{child.tag}> in <{parent.tag} {parent.get('name', '')}>"
        keys = sorted(child.attrib)
        numeric = [k for k in keys if k in NUMERIC]
        what = rng.choices(
            ["number", "drop attribute", "drop element", "double", "part", "rename attribute",
             "rename element", "axis", "name", "kind", "shuffle", "move", "limit", "all default"],
            [8, 3, 2, 2, 4, 2, 2, 2, 3, 1, 1, 1, 1, 1],
        )[0]  # fmt: skip
        if what == "number" and numeric:
            key = rng.choice(numeric)
            child.set(key, _number(rng, child.get(key, "")))
            done.append(f"{where}: {key}={child.get(key)!r}")
        elif what == "drop attribute" and keys:
            key = rng.choice(keys)
            del child.attrib[key]
            done.append(f"{where}: {key} dropped")
        elif what == "drop element":
            parent.remove(child)
            done.append(f"{where} dropped")
        elif what == "double":
            twin = copy.deepcopy(child)
            if numeric and rng.random() < 0.7:
                key = rng.choice(numeric)
                twin.set(key, " ".join(["0.7"] * len(child.get(key, "").split())))
            parent.insert(rng.randrange(len(parent) + 1), twin)
            done.append(f"{where} doubled")
        elif what == "part":
            part = rng.choice(PARTS)
            child.insert(rng.randrange(len(child) + 1), ET.fromstring(part))
            done.append(f"{part} put into <{child.tag} {child.get('name', '')}>")
        elif what == "rename attribute" and keys:
            key = rng.choice(keys)
            new = rng.choice([key.upper(), key[::-1], key + "1", "xyz", "rpy", "value"])
            child.set(new, child.attrib.pop(key))
            done.append(f"{where}: {key} renamed {new}")
        elif what == "rename element":
            new = rng.choice([child.tag.upper(), child.tag + "s", "origin", "axis", "limit"])
            done.append(f"{where} renamed {new}")
            child.tag = new
        elif what == "axis":
            joints = [j for j in root.findall("joint") if j.find("axis") is not None]
            if joints:
                axis = rng.choice(joints).find("axis")
                assert axis is not None
                axis.set("xyz", rng.choice(AXES))
                done.append(f"axis xyz={axis.get('xyz')!r}")
        elif what == "name":
            named = [e for e in root.iter() if e.get("name") is not None]
            element = rng.choice(named)
            old, new = element.get("name"), rng.choice(NAMES)
            element.set("name", new)
            for e in root.iter():
                if element.tag == "link" and e.get("link") == old:
                    e.set("link", new)
            done.append(f"<{element.tag}> {old!r} renamed {new!r}")
        elif what == "kind":
            joints = root.findall("joint")
            if joints:
                joint = rng.choice(joints)
                joint.set("type", rng.choice(KINDS))
                done.append(f"joint {joint.get('name')} type={joint.get('type')!r}")
        elif what == "shuffle":
            order = list(parent)
            rng.shuffle(order)
            for e in list(parent):
                parent.remove(e)
            parent.extend(order)
            done.append(f"children of <{parent.tag}> shuffled")
        elif what == "move":
            other = rng.choice(list(root.iter()))
            if other is not child and other not in list(child.iter()):
                parent.remove(child)
                other.append(child)
                done.append(f"{where} moved into <{other.tag}>")
        elif what == "limit":
            limits = list(root.iter("limit"))
            if limits:
                element = rng.choice(limits)
                element.set("lower", rng.choice(["3", "-1e300", "1e-320", "0", "-0.0", "nan"]))
                done.append(f"limit lower={element.get('lower')!r}")
        elif what == "all default" and numeric:
            for key in numeric:
                del child.attrib[key]
            done.append(f"{where}: {', '.join(numeric)} dropped")
    return ET.tostring(root, encoding="unicode"), "; ".join(done) or "unchanged"


def textual(rng: random.Random, text: str) -> tuple[str, str]:
    """One change of the text itself."""
    i = rng.randrange(len(text))
    what = rng.randrange(12)
    if what == 0:
        return text[:i] + rng.choice('<>"&=/ \x00\x1b\u00a0é') + text[
            i + 1 :
        ], f"a character at {i}"
    if what == 1:
        return text[:i] + text[i + rng.randrange(1, 30) :], f"characters dropped at {i}"
    if what == 2:
        return text[:i], f"cut at {i}"
    if what == 3:
        j = text.find(">", i) + 1
        return text[:j] + "<!-- <axis xyz='0 1 0'/> -->" + text[j:], f"a comment at {j}"
    if what == 4:
        j = text.find(">", i) + 1
        return text[:j] + "<![CDATA[<mass value='3'/>]]>" + text[j:], f"CDATA at {j}"
    if what == 5:
        return text.replace('="0', '="&#48;', 1), "a character reference"
    if what == 6:
        return "<!DOCTYPE robot [<!ENTITY e '5'>]>" + text, "an entity"
    if what == 7:
        return "\ufeff" + text, "a byte order mark"
    if what == 8:
        return text.replace(" ", "\n", 40), "lines for spaces"
    if what == 9:
        j = text.find(">", i) + 1
        return text[:j] + "<?pi x?>" + text[j:], f"a processing instruction at {j}"
    if what == 10:
        return text.replace('"', "'"), "single quotes"
    return text.replace("<robot ", '<robot xmlns="http://u" ', 1), "a namespace"


@functools.cache
def sources() -> list[tuple[str, str, str | None]]:
    """Name, text and tool of what is mutated."""
    out: list[tuple[str, str, str | None]] = [
        ("two", TWO_LINK, None), ("slider", SLIDER, "rod"), ("two by name", TWO_LINK, "hand"),
    ]  # fmt: skip
    if ROBOTS is not None:
        for name in ("planar2r", "puma560", "scara", "stanford", "ur5"):
            out.append(
                (name, (ROBOTS / f"{name}.urdf").read_text(), "tool" if name != "ur5" else None)
            )
    try:
        import example_robot_data

        folder = Path(example_robot_data.__file__).parents[4] / "share/example-robot-data/robots"
        for name, file in (
            ("kinova", "kinova_description/robots/kinova.urdf"),
            ("twodof", "asr_twodof_description/urdf/TwoDofs.urdf"),
            ("pendulum", "double_pendulum_description/urdf/double_pendulum.urdf"),
        ):
            if (folder / file).is_file():
                out.append((name, (folder / file).read_text(), None))
    except ImportError:
        pass
    return out


def mutants(seed: int, count: int) -> list[tuple[str, tuple[str, str | None, int]]]:
    """``count`` mutants with their labels; the same for the same seed."""
    rng = random.Random(seed)
    known = sources()
    weights = [6, 4, 2] + [1] * (len(known) - 3)
    out = []
    for i in range(count):
        name, text, tool = rng.choices(known, weights)[0]
        changed, what = (structural if rng.random() < 0.85 else textual)(rng, text)
        out.append((f"#{i} {name}: {what}", (changed, tool, i)))
    return out


def benign(seed: int, count: int) -> list[tuple[str, tuple[str, str | None, int]]]:
    """Other spellings of the same robots, all within the specification."""
    rng = random.Random(seed)
    out = []
    for i in range(count):
        name, text, tool = rng.choice(sources()[:6])
        root = ET.fromstring(text)
        for element in root.iter():
            for key in sorted(set(element.attrib) & NUMERIC):
                words = []
                for word in element.get(key, "").split():
                    form = rng.randrange(5)
                    value = float(word)
                    words.append(
                        [word, f"+{word}" if value >= 0 and word[0] != "+" else word,
                         f"{value:.17e}", f"{value!r}".replace("0.", ".", 1)
                         if word.startswith("0.") and len(word) > 2 else word,
                         f"{word}0" if "." in word and "e" not in word else word][form]
                    )  # fmt: skip
                pad = rng.choice(["", " ", "\t", "\n "])
                element.set(key, pad + rng.choice([" ", "  ", "\n"]).join(words) + pad)
            items = list(element.attrib.items())
            rng.shuffle(items)
            element.attrib.clear()
            element.attrib.update(items)
        order = list(root)
        rng.shuffle(order)
        root[:] = order
        out.append((f"#{i} {name} respelled", (ET.tostring(root, encoding="unicode"), tool, i)))
    return out
