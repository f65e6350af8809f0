# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of segments on a mesh in Object Mode: slots, marks, sets, groups, attributes, objects.

`labels` (f,) int32 are the segments of the faces, -1 for none; `taking` (f,) bool says which faces took part,
all others keep what they have.
"""
