"""The gallery: figures of Rowe et al. 2024 on meshes of our own, one module each, drawn by `draw_gallery.py`.

A module with a figure has `draw(folder) -> dict[str, str]`: it saves its pictures to `folder` and returns
Markdown tables of what it measured, by the name of the markers in docs/gallery.md between which they stand.
"""
