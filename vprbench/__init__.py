"""A Gymnasium-style environment and benchmark suite for visual place recognition."""
