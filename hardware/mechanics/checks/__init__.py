"""Checks of what make.py wrote: on the files alone, with other means than those that made them."""
