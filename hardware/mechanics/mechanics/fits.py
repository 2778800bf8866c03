"""Sizes of what fits what, mm, each with its reason.

Nothing here was printed yet: print a fit first, and change it here.
"""

# Usual printers (0.4 mm nozzle) are off by about 0.1 mm on each face: two faces that must pass each
# other get twice that.
FIT = 0.2
# Holes come out narrower than drawn: circles are polygons, and the bead is laid inside them.
HOLE_FIT = 0.3
# Three beads of a 0.4 mm nozzle: thinner walls break and leak.
MIN_WALL = 1.2
# Wall of the moulds: stiff enough not to bulge under a cable tie.
MOULD_WALL = 3.0
# Around a chip, so that silicone flows past it and no print presses on it.
CHIP_GAP = 0.3
# Between the parts under the board and the lid: solder joints and flux stand out of their drawn size.
PARTS_GAP = 0.7
# Plates that screws pull on.
PLATE = 3.0
# Outer edges of prints: no elephant's foot, and fingers can grip.
CHAMFER = 0.5
# A housing around a gel whose description has no shell: it has to hold the board, and stays beside
# the gel's foot, which hardly moves.
FREE_GAP, FREE_HEIGHT, FREE_WALL = 1.0, 3.0, 2.0
# Holes through the port plate that silicone fills and grips: narrow above, wide below.
ANCHOR_TOP_RADIUS, ANCHOR_BOTTOM_RADIUS = 0.7, 0.95
# Distance of the anchors from the gel's rim, and from each other at least.
ANCHOR_INSET, ANCHOR_PITCH = 1.5, 5.0
# Filling: a Luer syringe's cone (4.3 mm at its end) seats in it.
FILL_RADIUS, FILL_CONE_RADIUS, FILL_CONE_HEIGHT = 2.0, 4.0, 3.0
# A vent: wide enough to print and to show silicone, narrow enough to be cut without a trace worth naming.
VENT_RADIUS = 0.8
# Distance of fill and vent holes from the gel's rim.
FILL_INSET, VENT_INSET = 4.0, 2.0
# Tolerances of triangles: their distance from the exact surface, and their turn, radians. The
# kernel holds spheres to the turn alone.
STL_DEFLECTION, STL_ANGLE = 0.01, 0.12
