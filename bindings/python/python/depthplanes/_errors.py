"""What can go wrong, by whose fault it is. Texts say what was given, what is accepted, what to do."""

from __future__ import annotations


class Error(Exception):
    """Any error of this package."""


class InputError(Error, ValueError):
    """A value that is not accepted: a parameter, a unit, a camera, the content of a file."""


class InputIndexError(InputError, IndexError):
    """A plane that is not there."""


class InputTypeError(Error, TypeError):
    """A type that is not accepted, or a keyword that does not exist."""


class FileError(Error, OSError):
    """A file that the system does not let be read or written."""


class MissingFileError(FileError, FileNotFoundError):
    """A file or a folder that is not there."""


class OutOfMemoryError(Error, MemoryError):
    """Memory that cannot be had; the text says how much is needed."""


class MissingPackageError(Error, ImportError):
    """A package that a conversion needs and that cannot be imported; the text says why, or what to type."""


class ReadingWarning(UserWarning):
    """What a person should know of how a map was read, or of what was found in it."""
