"""Evaluates the surrogate of PhysTac's gel under a cube and a ball, some microseconds each."""

from twintac import Body, FastGel, Pose, Shape

cube = Body(Shape.box((10.0, 10.0, 10.0), edge_radius_mm=0.8))
ball = Body(Shape.sphere(radius_mm=5.0))
reader = FastGel.phystac().reader()
for depth_mm in (0.5, 1.0, 1.5):
    touching = [(cube, Pose((-8.0, 0.0, 8.5 - depth_mm))), (ball, Pose((8.0, 4.0, 8.5 - depth_mm)))]
    pressure_kpa, wrench = reader.read(touching)
    print(f"{depth_mm} mm: {-wrench[2]:.2f} N, {pressure_kpa.round(2)} kPa, {reader.provenance}")
