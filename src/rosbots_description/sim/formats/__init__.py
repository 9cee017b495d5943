"""From text to description: one folder for each language, each fault with file and line."""
