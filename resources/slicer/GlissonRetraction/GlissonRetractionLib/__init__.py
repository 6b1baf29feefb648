"""What the module GlissonRetraction does, without Slicer's classes."""
