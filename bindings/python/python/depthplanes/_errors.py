"""What can go wrong, by whose fault it is. Texts are those of the program: what was given, what is accepted, what to do."""

from __future__ import annotations


class Error(Exception):
    """Any error of this package."""


class InputError(Error, ValueError):
    """A value that is not accepted: a parameter, a unit, a camera, the content of a file."""


class InputTypeError(Error, TypeError):
    """A type that is not accepted, or a keyword that does not exist."""


class FileError(Error, OSError):
    """A file that the system does not let be read or written."""


class MissingFileError(FileError, FileNotFoundError):
    """A file or a folder that is not there."""


class MissingPackageError(Error, ImportError):
    """A package that a conversion needs and that is not installed; the text says what to type."""


class ReadingWarning(UserWarning):
    """What a person should know of how a map was read, or of what was found in it."""
