"""The amount of silicone for a sensor, and the casting sheet."""
