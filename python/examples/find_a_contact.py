"""Finds from readings where a ball touches, how deep and how hard."""

from twintac import Body, FastGel, Inverse, Pose, Shape

gel = FastGel.phystac()
shapes = {"ball": Shape.sphere(radius_mm=5.0), "die": Shape.box((8.0, 8.0, 8.0), edge_radius_mm=0.5)}
tracker = Inverse(gel, shapes).start("simulated")
reader, ball = gel.reader(), Body(shapes["ball"])
for frame in range(20):
    true = Pose((-4.0 + 0.1 * frame, 2.0, 8.5 - 0.1 * frame))
    contact = tracker.update(0.01, reader.read([(ball, true)])[0])
    print(contact or "nothing touches")
