"""Estimates from readings the location, depth and force of a ball, and the pressure that it causes
at the base of the gel, also between the taxels.
"""

from twintac import Body, FastGel, Inverse, Pose, Shape

gel = FastGel.phystac()
shapes = {"ball": Shape.sphere(radius_mm=5.0), "die": Shape.box((8.0, 8.0, 8.0), edge_radius_mm=0.5)}
inverse = Inverse(gel, shapes)
tracker, floor = inverse.start("simulated"), inverse.floor_map(spacing_mm=0.5)
reader, ball = gel.reader(), Body(shapes["ball"])
for frame in range(20):
    true = Pose((-4.0 + 0.1 * frame, 2.0, 8.5 - 0.1 * frame))
    contact = tracker.update(0.01, reader.read([(ball, true)])[0])
    if contact is not None:
        print(f"{contact}, {floor.read(contact).max():.1f} kPa on the floor")
