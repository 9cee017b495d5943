"""The reader has a Python module of this name, too."""
