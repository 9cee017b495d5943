"""Reads URDF by the rules of sdformat 9."""

from .urdf import load_urdf

__all__ = ['load_urdf']
