"""Planes in the forms of other packages: a file each, which is imported only when it is asked for."""
