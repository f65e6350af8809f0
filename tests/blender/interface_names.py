"""The names that stand in Blender's interface: those of the extension, and those of Blender itself."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import bpy
from bl_ext.user_default.ridgeform import registry
from bl_ext.user_default.ridgeform.check.kinds import KINDS
from bl_ext.user_default.ridgeform.framework import menus

ADDON = Path(registry.__file__).parent
EXTENDED = {"VIEW3D_MT_object", "VIEW3D_MT_edit_mesh"}
"""Blender's menus that the submenu of the extension is in."""
MENU = menus.RIDGEFORM_MT_tools.bl_label


def menu_entries() -> set[str]:
    """What the submenu of the extension offers, without the words for the search."""
    return {text.partition(" (")[0] for _, text, _ in menus._entries}


@cache
def own_names() -> frozenset[str]:
    """The labels of the extension: panels, operators, settings, choices, presets, cures, texts of buttons."""
    names = {"Ridgeform", "Ridgeform Blend"} | menu_entries() | {kind.cure for kind in KINDS if kind.cure}
    for tool in registry.TOOLS:
        names |= {tool.label, tool.panel_label, *(tool.presets or ())}
        for setting in tool.settings.declared.values():
            names |= {setting.label, setting.section, *(item[1] for item in setting.items)}
    for cls in registry.CLASSES:
        names.add(getattr(cls, "bl_label", ""))
        if issubclass(cls, bpy.types.Operator):
            kind = getattr(bpy.ops.ridgeform, cls.bl_idname.partition(".")[2]).get_rna_type()
            names |= _of_properties(kind)
    for path in ADDON.rglob("*.py"):
        names |= set(_texts(ast.parse(path.read_text(encoding="utf-8"))))
    return frozenset(name.rstrip("….") for name in names) - {""}


def _of_properties(kind: bpy.types.Struct) -> set[str]:
    """The names of the properties of a type, and of their choices."""
    names = set()
    for prop in kind.properties:
        names |= {prop.name, *(item.name for item in getattr(prop, "enum_items", ()))}
    return names


def _texts(tree: ast.AST) -> Iterator[str]:
    """The constant texts of the rows and buttons that code draws."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            for word in node.keywords:
                if word.arg in {"text", "heading", "name"} and isinstance(word.value, ast.Constant):
                    yield str(word.value.value)


@cache
def _blender_sources() -> tuple[ast.Module, ...]:
    folder = Path(bpy.utils.resource_path("LOCAL")) / "scripts"
    parts = ("startup/bl_ui", "startup/bl_operators", "addons_core/bl_pkg")
    paths = [path for part in parts for path in folder.glob(f"{part}/*.py")]
    return tuple(ast.parse(path.read_text(encoding="utf-8")) for path in sorted(paths))


@cache
def blender_names() -> frozenset[str]:
    """The texts of Blender's menus, panels, and buttons, the labels of its operators and their settings."""
    names = set()
    for tree in _blender_sources():
        names |= set(_texts(tree))
    for labels in _menus()[0].values():
        names |= labels
    for owner in (bpy.types.SpaceProperties, bpy.types.Preferences):
        names |= _of_properties(owner.bl_rna)
    names |= {item.name for item in bpy.types.Modifier.bl_rna.properties["type"].enum_items}
    kinds = (getattr(getattr(bpy.types, name), "bl_rna", None) for name in dir(bpy.types) if "Node" in name)
    names |= {kind.name for kind in kinds if kind is not None}
    for group in ("object", "mesh", "uv", "geometry", "export_scene", "wm"):
        module = getattr(bpy.ops, group)
        for name in dir(module):
            kind = getattr(module, name).get_rna_type()
            names |= {kind.name} | _of_properties(kind)
    return frozenset(name.rstrip("….") for name in names)


@cache
def _menus() -> tuple[dict[str, set[str]], dict[str, set[tuple[str, str]]]]:
    """Of each menu of Blender its labels, and its entries: a menu or an operator, and its text."""
    labels: dict[str, set[str]] = {}
    entries: dict[str, set[tuple[str, str]]] = {}
    parts: list[tuple[str, str]] = []
    for tree in _blender_sources():
        for cls in ast.walk(tree):
            if not isinstance(cls, ast.ClassDef):
                continue
            for node in ast.walk(cls):
                if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "bl_label":
                    labels.setdefault(cls.name, set()).add(ast.literal_eval(node.value))
                elif _is_entry(node):
                    texts = [w.value.value for w in node.keywords if _is_text(w)]
                    entries.setdefault(cls.name, set()).add((node.args[0].value, "".join(texts)))
                    if node.func.attr == "menu_contents":
                        parts.append((cls.name, node.args[0].value))
    for whole, part in parts:
        entries[whole] |= entries.get(part, set())
    for found in entries.values():
        for idname, text in found:
            if text and idname in labels:
                labels[idname].add(text)
    return labels, entries


def _is_text(word: ast.keyword) -> bool:
    return word.arg == "text" and isinstance(word.value, ast.Constant)


def _is_entry(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Call)
        and getattr(node.func, "attr", "") in {"menu", "menu_contents", "operator", "operator_menu_enum"}
        and bool(node.args)
        and isinstance(node.args[0], ast.Constant)
    )


def _label_of(idname: str, text: str) -> set[str]:
    if text:
        return {text.removesuffix("...")}
    labels = _menus()[0].get(idname)
    if labels is not None:
        return labels
    group, _, name = idname.partition(".")
    if not name or name not in dir(getattr(bpy.ops, group)):
        return set()
    return {getattr(getattr(bpy.ops, group), name).get_rna_type().name}


def leads_somewhere(path: list[str]) -> bool:
    """Whether a path through menus is there: each part in the one before, in any of several of that name.

    What an operator opens, choices or an editor, and paths through editors, need only have these names.
    """
    labels, entries = _menus()
    here = {name for name, texts in labels.items() if path[0] in texts and "_MT_" in name}
    for place, part in enumerate(path[1:], start=1):
        if not here & labels.keys():
            return all(is_name(part) for part in path)
        if part == MENU and here & EXTENDED:
            return path[place + 1 :] == [] or path[place + 1 :] in [[entry] for entry in menu_entries()]
        if "TOPBAR_MT_file_export" in here and path[place:] in [[name] for name in own_names()]:
            return True
        inside = {entry for name in here for entry in entries.get(name, ())}
        here = {idname for idname, text in inside if part in _label_of(idname, text)}
        if not here:
            return False
    return True


def is_name(text: str) -> bool:
    """Whether a text stands somewhere in the interface."""
    return text in own_names() or text in blender_names()
