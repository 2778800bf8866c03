"""Presses a ball into PhysTac, prints eight pressures, and draws them."""

from twintac import Gel, Press, PressureMap, Sensor

sensor = Sensor.phystac()
pressed = Gel(sensor).press(Press("sphere-25", at_mm=(-4.0, 4.0), depth_mm=1.0))
readings_kpa = pressed.readings_kpa[-1]
for taxel, pressure_kpa in zip(sensor.taxels, readings_kpa):
    print(f"{taxel} {pressure_kpa:6.2f} kPa, {pressed.provenance}")
PressureMap(sensor, readings_kpa, pressed.provenance).save("ball.png")
