"""Checks of the files that make.py wrote. They use the files alone, and other methods than those
that made the files.
"""
