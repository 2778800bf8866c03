"""The mechanics of a sensor, made from its geometry.json.

Prints, checks, pictures, casting sheet. Lengths are in mm.
"""
