"""What scripts, timers and other windows can do to a mesh that a tool is at work on."""

import addon_kit as kit
import bmesh
import bpy


def add_vertices(obj):
    """Loose vertices."""
    obj.data.vertices.add(7)


def delete_faces(obj):
    """Fewer faces."""
    with kit.edited(obj) as mesh:
        bmesh.ops.delete(mesh, geom=mesh.faces[:3], context="FACES")


def flip_faces(obj):
    """As many faces, turned over."""
    obj.data.flip_normals()


def move_vertices(obj):
    """The same mesh of another shape."""
    obj.data.vertices[5].co.x += 1.0


def add_layer(obj):
    """A new attribute."""
    obj.data.attributes.new("new", "FLOAT", "POINT")


def remove_layers(obj):
    """Without what is painted on it."""
    obj.data.attributes.remove(obj.data.attributes["heat"])
    obj.data.color_attributes.remove(obj.data.color_attributes["paint"])


def add_keys(obj):
    """Shape keys."""
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Later")


def remove_group(obj):
    """Without a vertex group."""
    obj.vertex_groups.remove(obj.vertex_groups[0])


def unlink(obj):
    """In no scene."""
    for collection in obj.users_collection:
        collection.objects.unlink(obj)


def replace_mesh(obj):
    """Another mesh in the object."""
    obj.data = obj.data.copy()


def switch_mode(obj):
    """Into Edit Mode."""
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")


def rename(obj):
    """Another name."""
    obj.name = obj.data.name = "Another"


def hide(obj):
    """Not to be seen."""
    obj.hide_viewport = True
    obj.hide_set(True)


def deselect(obj):
    """Neither selected nor active."""
    obj.select_set(False)
    bpy.context.view_layer.objects.active = None


def delete(obj):
    """Gone."""
    bpy.data.objects.remove(obj)


CHANGES = (
    add_vertices,
    delete_faces,
    flip_faces,
    move_vertices,
    add_layer,
    remove_layers,
    add_keys,
    remove_group,
    unlink,
    replace_mesh,
    switch_mode,
)
"""What ends a run on the mesh."""
HARMLESS = (hide, rename, deselect)
"""What does not."""
