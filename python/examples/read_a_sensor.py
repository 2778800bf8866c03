"""Reads an emulated PhysTac.

For a real one, use `Reader.open("/dev/i2c-1", sensor, counts_per_pa=8)`, where 8 is its number of
counts per Pa.
"""

from twintac import Reader, Sensor

sensor = Sensor.phystac()
readings = []
with Reader.emulated(sensor) as reader:
    for reading in reader:
        readings.append(reading)
        print(f"{reading.time_s:.3f} s: {reading.readings_kpa.round(2)} kPa, {reading.temperatures_c.mean():.1f} °C, {reading.provenance}")
        if reading.sequence >= 350:  # the emulated ball presses after the first second
            break
