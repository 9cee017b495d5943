"""Model plugins, chosen by the library name that a description gives; importing registers them."""

from . import diff_drive  # noqa: F401
