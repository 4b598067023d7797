"""Localizers that ship with vprbench: memories of places."""
