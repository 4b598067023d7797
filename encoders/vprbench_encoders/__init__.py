"""Encoders that ship with vprbench: what pathways from a frame to its landmarks."""
