"""Command-line front ends: one module per executable, whose ``main`` returns the exit code."""
