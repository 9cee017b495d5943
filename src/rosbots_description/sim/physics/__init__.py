"""Physics engines, one folder each."""
