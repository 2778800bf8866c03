"""Clearances and other sizes of parts that fit together, mm, each with its reason.

Nothing has been printed yet: first print a test of each fit, and adapt the values here.
"""

# Usual printers (0.4 mm nozzle) have an error of about 0.1 mm on each face: two faces that must
# pass each other get twice that.
FIT = 0.2
# Printed holes are narrower than drawn: circles are polygons, and the bead is laid inside them.
HOLE_FIT = 0.3
# Three beads of a 0.4 mm nozzle: thinner walls break and leak.
MIN_WALL = 1.2
# Wall of the moulds: stiff enough not to bulge under a cable tie.
MOULD_WALL = 3.0
# Clearance around a chip, so that silicone flows past it and no print presses on it.
CHIP_GAP = 0.3
# Clearance between the parts under the board and the lid: solder joints and flux exceed the drawn
# size.
PARTS_GAP = 0.7
# Thickness of plates that screws pull on.
PLATE = 3.0
# Chamfer of outer edges of prints, against the widening of the first layers and for grip.
CHAMFER = 0.5
# A housing around a gel whose description has no shell: it holds the board, and is beside the
# lowest part of the gel, which hardly moves.
FREE_GAP, FREE_HEIGHT, FREE_WALL = 1.0, 3.0, 2.0
# Holes through the port plate that silicone fills and grips: narrow at the top, wide at the bottom.
ANCHOR_TOP_RADIUS, ANCHOR_BOTTOM_RADIUS = 0.7, 0.95
# Distance of the anchors from the gel's rim, and smallest distance between anchors.
ANCHOR_INSET, ANCHOR_PITCH = 1.5, 5.0
# Fill hole: the cone of a Luer syringe (4.3 mm at its end) fits in it.
FILL_RADIUS, FILL_CONE_RADIUS, FILL_CONE_HEIGHT = 2.0, 4.0, 3.0
# Vent: wide enough to print and to show silicone, narrow enough to be cut off without a relevant
# trace.
VENT_RADIUS = 0.8
# Distance of fill and vent holes from the gel's rim.
FILL_INSET, VENT_INSET = 4.0, 2.0
# Tolerances of triangles: their distance from the exact surface, mm, and their angle, radians. The
# CAD kernel applies only the angle to spheres.
STL_DEFLECTION, STL_ANGLE = 0.01, 0.12
